//! Translates the window system's events to signals of the visitor.

use winit::dpi::{PhysicalPosition, PhysicalSize};
use winit::event::{ElementState, KeyEvent, MouseButton, TouchPhase, WindowEvent};
use winit::keyboard::{ModifiersState, PhysicalKey};

use crate::visitor::input::{Key, Phase, Signal};
use soffio_config::Modifiers;

/// The signal of a window event; `None` for other events.
pub fn translate(event: &WindowEvent, size: PhysicalSize<u32>, modifiers: ModifiersState) -> Option<Signal> {
    Some(match event {
        WindowEvent::Focused(false) => Signal::FocusLost,
        WindowEvent::CursorMoved { position, .. } => Signal::Pointer(in_picture(*position, size)),
        WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => {
            Signal::Button(*state == ElementState::Pressed)
        }
        WindowEvent::Touch(touch) => Signal::Touch {
            finger: touch.id,
            at: in_picture(touch.location, size),
            phase: match touch.phase {
                TouchPhase::Started => Phase::Down,
                TouchPhase::Moved => Phase::Move,
                TouchPhase::Ended | TouchPhase::Cancelled => Phase::Up,
            },
        },
        WindowEvent::KeyboardInput { event, is_synthetic: false, .. } => Signal::Key(key(event, modifiers)?),
        _ => return None,
    })
}

/// Is the event an input by hand, of any kind that the panel library handles?
pub fn is_input(event: &WindowEvent) -> bool {
    use WindowEvent as E;
    matches!(
        event,
        E::KeyboardInput { .. }
            | E::Ime(_)
            | E::CursorMoved { .. }
            | E::CursorEntered { .. }
            | E::CursorLeft { .. }
            | E::MouseInput { .. }
            | E::MouseWheel { .. }
            | E::Touch(_)
            | E::PinchGesture { .. }
            | E::PanGesture { .. }
            | E::DoubleTapGesture { .. }
            | E::RotationGesture { .. }
            | E::TouchpadPressure { .. }
    )
}

/// A key by its position on the keyboard, so that a chord is the same on every layout.
fn key(event: &KeyEvent, modifiers: ModifiersState) -> Option<Key> {
    let PhysicalKey::Code(code) = event.physical_key else { return None };
    let name = format!("{code:?}");
    let short = name.strip_prefix("Key").or_else(|| name.strip_prefix("Digit"));
    Some(Key {
        name: short.unwrap_or(&name).to_owned(),
        pressed: event.state == ElementState::Pressed,
        repeat: event.repeat,
        modifiers: Modifiers { ctrl: modifiers.control_key(), alt: modifiers.alt_key(), shift: modifiers.shift_key() },
    })
}

/// Pixels to picture coordinates.
fn in_picture(at: PhysicalPosition<f64>, size: PhysicalSize<u32>) -> [f64; 2] {
    [at.x / f64::from(size.width.max(1)), at.y / f64::from(size.height.max(1))]
}
