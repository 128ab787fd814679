//! Gamepads and adaptive controllers: a trigger blows in proportion, a button blows a normal breath, a stick or the directional pad
//! moves the aim. Any number of pads may be connected and removed at any time.

use std::time::Duration;

use gilrs::{Axis, Button, EventType, Gilrs};

use super::driver::{Driver, Reading, Slot};

/// Dead zone of a stick.
const DEAD_ZONE: f32 = 0.15;

/// All pads together.
#[derive(Default)]
pub struct Gamepads {
    pads: Option<Gilrs>,
}

impl Driver for Gamepads {
    fn open(&mut self, _: &Slot) -> Result<String, String> {
        let pads = Gilrs::new().map_err(|error| match error {
            gilrs::Error::NotImplemented(_) => "this system has no gamepads".to_owned(),
            error => error.to_string(),
        })?;
        let names: Vec<String> = pads.gamepads().map(|(_, pad)| pad.name().to_owned()).collect();
        self.pads = Some(pads);
        Ok(if names.is_empty() { "any gamepad that is plugged in".into() } else { names.join(", ") })
    }

    fn listen(&mut self, slot: &Slot, wait: Duration) -> Result<(), String> {
        let pads = self.pads.as_mut().ok_or("not opened")?;
        if let Some(event) = pads.next_event_blocking(Some(wait)) {
            match event.event {
                EventType::Connected => tracing::info!("gamepad: {} is here", pads.gamepad(event.id).name()),
                EventType::Disconnected => tracing::info!("gamepad: {} is gone", pads.gamepad(event.id).name()),
                _ => {}
            }
            slot.update(|reading| enter(reading, &event.event));
        }
        Ok(())
    }
}

/// Enters an event of a pad.
fn enter(reading: &mut Reading, event: &EventType) {
    let rested = |value: f32| if value.abs() < DEAD_ZONE { 0.0 } else { f64::from(value) };
    match *event {
        EventType::ButtonChanged(Button::LeftTrigger2 | Button::RightTrigger2, pulled, _) => {
            reading.blow(f64::from(pulled));
        }
        EventType::ButtonPressed(Button::South | Button::East | Button::West | Button::North, _) => reading.press(true),
        EventType::ButtonReleased(Button::South | Button::East | Button::West | Button::North, _) => {
            reading.press(false);
        }
        EventType::ButtonChanged(Button::DPadLeft, value, _) => reading.tilt(0, -f64::from(value)),
        EventType::ButtonChanged(Button::DPadRight, value, _) => reading.tilt(0, f64::from(value)),
        EventType::ButtonChanged(Button::DPadUp, value, _) => reading.tilt(1, -f64::from(value)),
        EventType::ButtonChanged(Button::DPadDown, value, _) => reading.tilt(1, f64::from(value)),
        EventType::AxisChanged(Axis::LeftStickX | Axis::RightStickX, value, _) => reading.tilt(0, rested(value)),
        // A stick pushed away points up.
        EventType::AxisChanged(Axis::LeftStickY | Axis::RightStickY, value, _) => reading.tilt(1, -rested(value)),
        EventType::Disconnected => reading.let_go(),
        _ => {}
    }
}
