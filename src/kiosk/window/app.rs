//! State of the window thread, and the handlers of the window system's events.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::platform::wayland::WindowAttributesExtWayland;
use winit::window::{Fullscreen, Window, WindowId};

use super::events::{is_input, translate};
use super::launch::{Ended, Launch, Missing};
use super::parts::desk::StaffDesk;
use super::parts::exhibits::ExhibitSelection;
use super::parts::graphics::Graphics;
use super::parts::lifecycle::Lifecycle;
use super::parts::overlays::Overlays;
use super::parts::pacing::Pacing;
use super::parts::setup::Setup;
use super::parts::visit::VisitState;
use super::screen::Screen;
use super::shader_watcher::ShaderWatcher;
use crate::fleet::Fleet;
#[cfg(target_os = "linux")]
use crate::fleet::watchdog::Watchdog;
use crate::live::{Live, Options, Report};
use crate::pages::ui_strings::Translations;
use crate::step::command::KioskCommand;
use crate::venue::catalog::ExhibitSource;
use crate::venue::site::ConfigWatcher;
use crate::venue::state::{OverlayCapture, SignalContext, VenueState};

/// Size of a window on a desk, pixels.
const DESK_SIZE: PhysicalSize<u32> = PhysicalSize::new(1280, 720);
/// Longest sleep of the event loop, and so the longest delay until a signal or the end of a run is noticed.
const NAP: Duration = Duration::from_millis(50);
/// Time after which a due frame that was not requested shows that the display is off.
const UNASKED: Duration = Duration::from_secs(2);

/// State that exists once there is a window.
pub(super) struct WindowAndSimulation {
    /// The window with its graphics device.
    pub screen: Screen,
    /// The simulation thread.
    pub live: Live,
}

/// State of the window thread. Its methods are in the files beside this one, one for each concern.
pub(super) struct App<'a> {
    /// Configuration of this run.
    pub setup: Setup,
    /// Start and end of the run.
    pub life: Lifecycle<'a>,
    /// Window and simulation; `None` before there is a window.
    pub show: Option<WindowAndSimulation>,
    /// State of the graphics.
    pub graphics: Graphics,
    /// State of frame pacing.
    pub pacing: Pacing,
    /// Pages and texts over the picture.
    pub overlays: Overlays,
    /// Exhibits on offer.
    pub exhibits: ExhibitSelection,
    /// State of the present visit.
    pub visit: VisitState,
    /// Staff panel and log.
    pub desk: StaffDesk,
    /// Opening, cleaning and blanking of the venue.
    pub venue: VenueState,
    /// Counters, persisted state and reports.
    pub fleet: Fleet,
    /// Keep-alive of systemd.
    #[cfg(target_os = "linux")]
    pub watchdog: Watchdog,
}

impl<'a> App<'a> {
    /// The state before there is a window.
    pub(super) fn new(
        ground: Launch,
        places: &ExhibitSource,
        options: Options,
        events: &EventLoop<()>,
        interrupted: &'a AtomicBool,
    ) -> Self {
        let display = Box::new(events.owned_display_handle());
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            ..wgpu::InstanceDescriptor::new_with_display_handle_from_env(display)
        });
        let translations =
            if ground.fleet.is_safe() { Translations::default() } else { Translations::load(ground.file.as_deref()) };
        let Launch { config, overrides, file, state, problem, warnings, log, fleet, lose_device_at, shaders } = ground;
        Self {
            exhibits: ExhibitSelection::new(places, &options.exhibit.folder, config.exhibits.hot_reload, &fleet),
            visit: VisitState::new(&config, fleet.persisted().breath_time.clone()),
            setup: Setup {
                seed: options.site.settings.seed,
                one: matches!(places, ExhibitSource::One(_)),
                overrides,
                file: file.as_deref().map(|file| ConfigWatcher::watch(file, state.as_deref())),
                problems: problem.into_iter().collect(),
                warnings,
                config,
            },
            life: Lifecycle {
                interrupted,
                waiting: Some(options),
                waker: events.create_proxy(),
                missing: None,
                failure: None,
            },
            show: None,
            graphics: Graphics::new(instance, shaders.map(ShaderWatcher::new), lose_device_at),
            pacing: Pacing::default(),
            overlays: Overlays::new(translations),
            desk: StaffDesk::new(log),
            venue: VenueState::default(),
            fleet,
            #[cfg(target_os = "linux")]
            watchdog: Watchdog::default(),
        }
    }

    /// Ends the run; `looped` is the result of the event loop.
    pub(super) fn end(mut self, looped: Result<(), String>) -> Result<Ended, Missing> {
        #[cfg(target_os = "linux")]
        self.watchdog.end();
        if let Some(missing) = self.life.missing {
            self.fleet.end();
            return Err(missing);
        }
        let counts = self.pacing.counts();
        tracing::info!("{} frames were shown, {} of them idle", counts.shown, counts.at_rest);
        let report = self.show.map_or_else(|| Ok(Report::default()), |show| show.live.finish());
        // A failed run does not end in order: the persisted state shows it as a crash.
        Ok(match (self.life.failure.take(), looped.and(report)) {
            (Some(failure), _) | (None, Err(failure)) => Ended::Failed(failure),
            (None, Ok(report)) => {
                self.fleet.end();
                if self.life.is_interrupted() { Ended::Interrupted } else { Ended::Done(report) }
            }
        })
    }

    /// Shows a message to staff, on the panel and in the log.
    pub(super) fn say(&mut self, message: String) {
        self.desk.say(self.pacing.time(), message);
    }
}

impl ApplicationHandler for App<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        self.update_hours();
        let closed = !self.venue.is_open();
        let Some(options) = self.life.waiting.take().map(|options| Options { closed, ..options }) else { return };
        let screen = open(events, self.setup.on_desk())
            .map_err(Missing::Display)
            .and_then(|w| self.graphics.open(w, &options.exhibit).map_err(Missing::Graphics));
        match screen {
            // The motion begins when there is a window, with the aspect of its picture.
            Ok(screen) => match Live::start(options, screen.aspect(), self.life.wakes()) {
                Ok(live) => {
                    tracing::info!("{:?} pixels on {}", screen.size(), screen.adapter().0);
                    live.send(KioskCommand::Loudness(self.fleet.volume_requests()));
                    self.show = Some(WindowAndSimulation { screen, live });
                }
                Err(error) => self.life.fail(events, error),
            },
            Err(missing) => self.life.miss(events, missing),
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, (): ()) {
        self.pacing.wake();
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        if event != WindowEvent::RedrawRequested {
            self.pacing.count_input();
        }
        let desk = self.setup.on_desk();
        let time = self.pacing.time();
        // While the screen is cleaned every input is ignored.
        if self.venue.cleaning_left(time).is_some() && is_input(&event) {
            return;
        }
        let Some(show) = &mut self.show else { return };
        let panel = &mut show.screen.panel;
        let _ = panel.on_window_event(&show.screen.window, &event);
        match event {
            WindowEvent::RedrawRequested => return self.draw(events),
            WindowEvent::Resized(size) => {
                show.screen.resize(size);
                show.live.inbox().controls.aspect = show.screen.aspect();
                return;
            }
            WindowEvent::CloseRequested if desk => return events.exit(),
            WindowEvent::ModifiersChanged(modifiers) => {
                self.visit.modifiers = modifiers.state();
                return;
            }
            _ => {}
        }
        let Some(signal) = translate(&event, show.screen.window.inner_size(), self.visit.modifiers) else { return };
        let points = panel.egui_ctx().content_rect();
        let above = OverlayCapture { pointer: self.desk.panel.handle_signal(&signal), keys: self.desk.panel.is_open() };
        let button = match self.visit.visitor.press_position(&signal) {
            Some([x, y]) if !above.pointer && self.venue.accepts_input(time) => {
                self.overlays.button_at(points.lerp_inside(egui::vec2(x as f32, y as f32)))
            }
            _ => None,
        };
        let request = match button {
            // A press on a button is an input, but no breath.
            Some(request) => {
                self.visit.visitor.count_input();
                Some(request)
            }
            None => {
                let keys = self.setup.keys(self.overlays.menu.open);
                self.venue.signal(time, &mut self.visit.visitor, &signal, SignalContext { keys, captured: above }, desk)
            }
        };
        self.stop_reading_on(&signal, request);
        if let Some(request) = request.and_then(|request| self.desk.panel.admit(request, &self.setup.config.staff)) {
            self.handle_request(events, request);
        }
        self.send_controls();
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let over = self.show.as_ref().is_some_and(|show| show.live.is_over());
        if over || self.life.is_interrupted() {
            return events.exit();
        }
        while let Some(event) = self.exhibits.loader.next_event() {
            self.handle_catalog_event(event);
        }
        self.update_config();
        self.update_hours();
        self.update_fleet();
        self.update_shaders();
        let now = Instant::now();
        let due = now >= self.pacing.clock.next;
        if let Some(show) = self.show.as_ref().filter(|_| due) {
            show.screen.window.request_redraw();
        }
        // A compositor with its display off requests no frame. The kiosk offers one, and counts as alive if it is refused.
        if now >= self.pacing.clock.next + UNASKED {
            self.draw(events);
        }
        // With a graphics processor the next frame is due at once and waits for the display, which wakes the loop.
        let nap = now + NAP;
        events.set_control_flow(ControlFlow::WaitUntil(if due { nap } else { self.pacing.clock.next.min(nap) }));
    }
}

/// Opens the window: fullscreen, or on a desk.
fn open(events: &ActiveEventLoop, on_desk: bool) -> Result<Arc<Window>, String> {
    // A compositor assigns the window to a screen by its name.
    let plain =
        Window::default_attributes().with_title("Soffio").with_name("soffio", "soffio").with_inner_size(DESK_SIZE);
    let attributes = match on_desk {
        true => plain,
        false => plain.with_decorations(false).with_fullscreen(Some(Fullscreen::Borderless(None))),
    };
    let window = events.create_window(attributes).map_err(|error| error.to_string())?;
    window.set_cursor_visible(false);
    Ok(Arc::new(window))
}
