//! The window thread's state, part by part, and the window system's events as they come in.

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
use super::ground::{Ended, Ground, Missing};
use super::parts::desk::Desk;
use super::parts::graphics::Graphics;
use super::parts::life::Life;
use super::parts::overlaid::Overlaid;
use super::parts::pacing::Pacing;
use super::parts::setup::Setup;
use super::parts::visit::Visit;
use super::parts::works::Works;
use super::screen::Screen;
use super::workbench::Workbench;
use crate::fleet::Fleet;
#[cfg(target_os = "linux")]
use crate::fleet::watchdog::Watchdog;
use crate::live::{Live, Options, Report};
use crate::pages::ui_strings::Translations;
use crate::step::command::KioskCommand;
use crate::venue::house::{Above, House};
use crate::venue::shelf::Places;
use crate::venue::site::SiteFile;

/// Size of the window on a desk, pixels.
const DESK_SIZE: PhysicalSize<u32> = PhysicalSize::new(1280, 720);
/// Longest sleep of the event loop: a signal, or the end of a run, is seen at the latest after this.
const NAP: Duration = Duration::from_millis(50);
/// A picture that is due for so long was not asked for: the display is off.
const UNASKED: Duration = Duration::from_secs(2);

/// What exists once there is a window.
pub(super) struct Show {
    pub screen: Screen,
    pub live: Live,
}

/// All that the window thread owns. What it does with it is in the files beside this one, one for each concern.
pub(super) struct App<'a> {
    pub setup: Setup,
    pub life: Life<'a>,
    pub show: Option<Show>,
    pub graphics: Graphics,
    pub pacing: Pacing,
    pub overlaid: Overlaid,
    pub works: Works,
    pub visit: Visit,
    pub desk: Desk,
    pub house: House,
    pub fleet: Fleet,
    #[cfg(target_os = "linux")]
    pub watchdog: Watchdog,
}

impl<'a> App<'a> {
    /// Before there is a window.
    pub(super) fn new(
        ground: Ground,
        places: &Places,
        options: Options,
        (events, interrupted): (&EventLoop<()>, &'a AtomicBool),
    ) -> Self {
        let display = Box::new(events.owned_display_handle());
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            ..wgpu::InstanceDescriptor::new_with_display_handle_from_env(display)
        });
        let translations =
            if ground.fleet.is_safe() { Translations::default() } else { Translations::load(ground.file.as_deref()) };
        let Ground { config, overrides, file, problem, log, fleet, lose_device_at, shaders } = ground;
        Self {
            works: Works::new(places, &options.exhibit.folder, config.exhibits.hot_reload),
            visit: Visit::new(&config, fleet.kept().given.clone()),
            setup: Setup {
                seed: options.site.settings.seed,
                one: matches!(places, Places::One(_)),
                overrides,
                file: file.as_deref().map(SiteFile::watch),
                says: problem.into_iter().collect(),
                config,
            },
            life: Life {
                interrupted,
                waiting: Some(options),
                waker: events.create_proxy(),
                missing: None,
                failure: None,
            },
            show: None,
            graphics: Graphics::new(instance, shaders.map(Workbench::new), lose_device_at),
            pacing: Pacing::default(),
            overlaid: Overlaid::new(translations),
            desk: Desk::new(log),
            house: House::default(),
            fleet,
            #[cfg(target_os = "linux")]
            watchdog: Watchdog::default(),
        }
    }

    /// Ends the run; `looped` is how the event loop ended.
    pub(super) fn end(mut self, looped: Result<(), String>) -> Result<Ended, Missing> {
        #[cfg(target_os = "linux")]
        self.watchdog.end();
        if let Some(missing) = self.life.missing {
            self.fleet.end();
            return Err(missing);
        }
        let counts = self.pacing.counts();
        tracing::info!("{} pictures were shown, {} of them at rest", counts.shown, counts.at_rest);
        let report = self.show.map_or_else(|| Ok(Report::default()), |show| show.live.finish());
        // A run that failed has not ended in order: what is kept says that it died.
        Ok(match (self.life.failure.take(), looped.and(report)) {
            (Some(failure), _) | (None, Err(failure)) => Ended::Failed(failure),
            (None, Ok(report)) => {
                self.fleet.end();
                if self.life.is_interrupted() { Ended::Interrupted } else { Ended::Done(report) }
            }
        })
    }

    /// For staff, on the panel and in the log.
    pub(super) fn say(&mut self, message: String) {
        self.desk.say(self.pacing.time(), message);
    }
}

impl ApplicationHandler for App<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        self.follow_hours();
        let closed = !self.house.is_open();
        let Some(options) = self.life.waiting.take().map(|options| Options { closed, ..options }) else { return };
        let screen = open(events, self.setup.on_desk())
            .map_err(Missing::Display)
            .and_then(|w| self.graphics.open(w, &options.exhibit).map_err(Missing::Graphics));
        match screen {
            // The motion begins when there is a window to see it in, in the shape of its picture.
            Ok(screen) => match Live::start(options, screen.aspect(), self.life.wakes()) {
                Ok(live) => {
                    tracing::info!("{:?} pixels on {}", screen.size(), screen.adapter().0);
                    live.send(KioskCommand::Loudness(self.fleet.wishes()));
                    self.show = Some(Show { screen, live });
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
            self.pacing.note_input();
        }
        let desk = self.setup.on_desk();
        let time = self.pacing.time();
        // Nothing that is wiped over while the glass is cleaned reaches anything.
        if self.house.cleans(time).is_some() && is_input(&event) {
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
        let above = Above { pointer: self.desk.panel.feel(&signal), keys: self.desk.panel.is_open() };
        let button = match self.visit.visitor.press_position(&signal) {
            Some([x, y]) if !above.pointer && self.house.hears(time) => {
                self.overlaid.button_at(points.lerp_inside(egui::vec2(x as f32, y as f32)))
            }
            _ => None,
        };
        let request = match button {
            // A press on a button is an input, but no breath.
            Some(request) => {
                self.visit.visitor.note();
                Some(request)
            }
            None => {
                let keys = self.setup.keys(self.overlaid.menu.open);
                self.house.signal(time, &mut self.visit.visitor, &signal, (keys, above), desk)
            }
        };
        self.hush_at(&signal, request);
        if let Some(request) = request {
            self.grant(events, request);
        }
        self.tell();
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let over = self.show.as_ref().is_some_and(|show| show.live.is_over());
        if over || self.life.is_interrupted() {
            return events.exit();
        }
        while let Some(news) = self.works.shelf.news() {
            self.hear(news);
        }
        self.follow_site();
        self.follow_hours();
        self.follow_fleet();
        self.follow_workbench();
        let now = Instant::now();
        let due = now >= self.pacing.clock.next;
        if let Some(show) = self.show.as_ref().filter(|_| due) {
            show.screen.window.request_redraw();
        }
        // A compositor whose display is off asks for no picture at all: the kiosk offers one, and is alive if it is refused.
        if now >= self.pacing.clock.next + UNASKED {
            self.draw(events);
        }
        // On a graphics processor the next picture is due at once and the display's rhythm makes it wait: its word wakes the loop.
        let nap = now + NAP;
        events.set_control_flow(ControlFlow::WaitUntil(if due { nap } else { self.pacing.clock.next.min(nap) }));
    }
}

/// Opens the window: all of the screen, or part of a desk.
fn open(events: &ActiveEventLoop, on_desk: bool) -> Result<Arc<Window>, String> {
    // By its name a compositor finds the screen that it belongs on.
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
