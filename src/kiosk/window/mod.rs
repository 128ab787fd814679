//! The window: events in, pictures out.
//!
//! In the gallery it fills the screen, hides the cursor and cannot be closed by anything that a visitor can press;
//! only the staff panel leads out, or a signal from the terminal. On somebody's desk (`--windowed`) it closes like
//! any window.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::keyboard::ModifiersState;
use winit::platform::wayland::WindowAttributesExtWayland;
use winit::window::{Fullscreen, Window, WindowId};

use soffio_config::Config;
use soffio_devices::audio::DeviceState;
use soffio_simulation::Snapshot;

use crate::attract::drift::Drift;
use crate::fleet::Fleet;
use crate::live::{self, Frame, Live, Report};
use crate::pages::aloud::Aloud;
use crate::pages::languages::unwritten;
use crate::pages::menu::Menu;
use crate::pages::overlay::Overlay;
use crate::staff::Staff;
use crate::staff::log::Log;
use crate::venue::house::{Above, House};
use crate::venue::shelf::{Offer, Places, Shelf};
use crate::venue::site::{Overrides, SiteFile};
use crate::visitor::dwell::Dwell;
use crate::visitor::given::Given;
use crate::visitor::input::{Keys, Request, Visitor};
use crate::visitor::needs::Needs;
use crate::window::events::{is_input, translate};
use crate::window::rest::Rest;
use crate::window::screen::Screen;
use crate::window::tiers::Tiers;
use crate::window::timing::{Clock, FirstSight};
use crate::window::workbench::Workbench;

mod asked;
mod day;
mod events;
mod fleet;
mod picture;
pub mod rest;
pub mod rhythm;
mod screen;
pub mod tiers;
mod timing;
mod visit;
pub mod workbench;
mod works;

/// Size of the window on a desk, pixels.
const DESK_SIZE: PhysicalSize<u32> = PhysicalSize::new(1280, 720);
/// Longest sleep of the event loop: a signal, or the end of a run, is seen at the latest after this.
const NAP: Duration = Duration::from_millis(50);
/// A picture that is due for so long was not asked for: the display is off.
const UNASKED: Duration = Duration::from_secs(2);

/// What a kiosk runs on, beside its exhibits.
pub struct Ground {
    /// The site's configuration as this run has it.
    pub config: Config,
    /// What the command line says over its file.
    pub overrides: Overrides,
    /// Its file, which is watched; `None` for the one that is built in.
    pub file: Option<std::path::PathBuf>,
    /// What is wrong with that file, where the run has the last good configuration instead.
    pub problem: Option<String>,
    /// What is logged.
    pub log: Log,
    /// What is counted, kept and told.
    pub fleet: Fleet,
    /// The graphics device is destroyed once, after so many seconds: a rehearsal of its loss.
    pub lose_device_at: Option<f64>,
    /// A folder of shaders that somebody works on.
    pub shaders: Option<std::path::PathBuf>,
}

/// Why there is no live kiosk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Missing {
    /// No display to open a window on.
    Display(String),
    /// No graphics adapter that can draw into the window.
    Graphics(String),
}

/// How a live kiosk ended.
#[derive(Clone, Debug)]
pub enum Ended {
    /// By itself, by staff, or by closing a window on a desk.
    Done(Report),
    /// By a signal from outside.
    Interrupted,
    /// Something broke.
    Failed(String),
}

/// Shows an exhibit, and lets visitors choose among those of `places`, until somebody ends it. `interrupted` is set by a
/// signal from outside.
pub fn run(
    ground: Ground,
    places: &Places,
    options: live::Options,
    interrupted: &AtomicBool,
) -> Result<Ended, Missing> {
    let events = event_loop().map_err(Missing::Display)?;
    let display = Box::new(events.owned_display_handle());
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::VULKAN,
        ..wgpu::InstanceDescriptor::new_with_display_handle_from_env(display)
    });
    let Ground { config, overrides, file, problem, log, fleet, lose_device_at, shaders } = ground;
    let given = fleet.kept().given.clone();
    let mut app = App {
        instance,
        interrupted,
        seed: options.site.settings.seed,
        one: matches!(places, Places::One(_)),
        overrides,
        site: file.as_deref().map(SiteFile::watch),
        site_says: problem.into_iter().collect(),
        work_says: None,
        fleet,
        lose_device_at,
        workbench: shaders.map(Workbench::new),
        log,
        house: House::default(),
        shelf: Shelf::new(places, &options.exhibit.folder, config.exhibits.hot_reload),
        offer: Offer::new(places),
        pictures: Vec::new(),
        turning: false,
        menu: Menu::default(),
        needs: Needs::of(&config.visit),
        aloud: Aloud::default(),
        dwell: Dwell::default(),
        turned: 0,
        listens: true,
        given,
        languages: Vec::new(),
        unwritten: unwritten(),
        language: String::new(),
        waiting: Some(options),
        show: None,
        visitor: Visitor::default(),
        modifiers: ModifiersState::default(),
        overlay: Overlay::default(),
        buttons: Vec::new(),
        staff: Staff::default(),
        cursor: false,
        attracts: false,
        visited: false,
        deaf: false,
        mute: false,
        clock: Clock::default(),
        rest: Rest::default(),
        inputs: 0,
        waker: events.create_proxy(),
        #[cfg(target_os = "linux")]
        watchdog: crate::fleet::watchdog::Watchdog::default(),
        pictures_shown: 0,
        pictures_dark: 0,
        pictures_at_rest: 0,
        sight: FirstSight::default(),
        drift: Drift::default(),
        moment: Snapshot::default(),
        tiers: Tiers::default(),
        lost: 0,
        missing: None,
        failure: None,
        config,
    };
    app.go_on();
    let looped = events.run_app(&mut app).map_err(|error| error.to_string());
    #[cfg(target_os = "linux")]
    app.watchdog.end();
    if let Some(missing) = app.missing {
        app.fleet.end();
        return Err(missing);
    }
    tracing::info!("{} pictures were shown, {} of them at rest", app.pictures_shown, app.pictures_at_rest);
    let report = app.show.map_or_else(|| Ok(Report::default()), |show| show.live.finish());
    // A run that failed has not ended in order: what is kept says that it died.
    Ok(match (app.failure, looped.and(report)) {
        (Some(failure), _) | (None, Err(failure)) => Ended::Failed(failure),
        (None, Ok(report)) => {
            app.fleet.end();
            if interrupted.load(Ordering::Relaxed) { Ended::Interrupted } else { Ended::Done(report) }
        }
    })
}

/// The connection to the display; the error is the system's reason alone, without the place in its library.
pub fn event_loop() -> Result<EventLoop<()>, String> {
    EventLoop::new().map_err(|error| error.to_string().rsplit(": ").next().unwrap_or_default().to_owned())
}

/// What exists once there is a window.
struct Show {
    screen: Screen,
    live: Live,
}

struct App<'a> {
    config: Config,
    /// Of all that is random.
    seed: u64,
    /// Is there one exhibit only?
    one: bool,
    overrides: Overrides,
    site: Option<SiteFile>,
    /// What staff should know of the configuration: what is wrong with it, what waits for a restart.
    site_says: Vec<String>,
    /// Why the work on show does not load as its files stand.
    work_says: Option<String>,
    log: Log,
    fleet: Fleet,
    lose_device_at: Option<f64>,
    workbench: Option<Workbench>,
    house: House,
    instance: wgpu::Instance,
    interrupted: &'a AtomicBool,
    /// The run, until there is a window to show it in.
    waiting: Option<live::Options>,
    show: Option<Show>,
    shelf: Shelf,
    offer: Offer,
    /// Pictures of the works, by id.
    pictures: Vec<(String, egui::TextureHandle)>,
    /// Is attract mode's next work being fetched?
    turning: bool,
    menu: Menu,
    needs: Needs,
    aloud: Aloud,
    dwell: Dwell,
    /// Works swiped on so far that were heeded.
    turned: i64,
    /// Has no visitor switched the microphone off?
    listens: bool,
    given: Given,
    visitor: Visitor,
    modifiers: ModifiersState,
    overlay: Overlay,
    /// Where a press is not a breath, in points.
    buttons: Vec<(egui::Rect, Request)>,
    staff: Staff,
    /// Is the cursor shown?
    cursor: bool,
    /// Languages a visitor can choose from, and the one chosen (empty: none yet).
    languages: Vec<String>,
    /// Those that this system's fonts cannot write.
    unwritten: Vec<&'static str>,
    language: String,
    attracts: bool,
    /// Was somebody here at the last picture?
    visited: bool,
    deaf: bool,
    mute: bool,
    clock: Clock,
    rest: Rest,
    /// Events of the window so far, but for its own pictures.
    inputs: u64,
    /// Lets the simulation end a rest.
    waker: EventLoopProxy<()>,
    #[cfg(target_os = "linux")]
    watchdog: crate::fleet::watchdog::Watchdog,
    /// Pictures so far, and those after which the next one waited because nothing moved.
    pictures_shown: u64,
    /// For which the display was off.
    pictures_dark: u64,
    pictures_at_rest: u64,
    sight: FirstSight,
    drift: Drift,
    /// What is shown; kept so that a picture needs no new memory for it.
    moment: Snapshot,
    tiers: Tiers,
    lost: u32,
    missing: Option<Missing>,
    failure: Option<String>,
}

impl ApplicationHandler for App<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        self.follow_hours();
        let closed = !self.house.is_open();
        let Some(options) = self.waiting.take().map(|options| live::Options { closed, ..options }) else { return };
        let screen = open(events, self.on_desk())
            .map_err(Missing::Display)
            .and_then(|w| Screen::new(self.instance.clone(), w, &options.exhibit).map_err(Missing::Graphics));
        match screen {
            // The motion begins when there is a window to see it in, in the shape of its picture.
            Ok(screen) => match Live::start(options, screen.aspect(), self.wakes()) {
                Ok(live) => {
                    tracing::info!("{:?} pixels on {}", screen.size(), screen.adapter().0);
                    live.controls().loudness = self.fleet.wishes();
                    self.show = Some(Show { screen, live });
                }
                Err(error) => self.fail(events, error),
            },
            Err(missing) => {
                self.missing = Some(missing);
                events.exit();
            }
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, (): ()) {
        self.wake();
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        if event != WindowEvent::RedrawRequested {
            self.inputs += 1;
            self.wake();
        }
        let desk = self.on_desk();
        let time = self.clock.seconds(Instant::now());
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
                show.live.controls().aspect = show.screen.aspect();
                return;
            }
            WindowEvent::CloseRequested if desk => return events.exit(),
            WindowEvent::ModifiersChanged(modifiers) => {
                self.modifiers = modifiers.state();
                return;
            }
            _ => {}
        }
        let Some(signal) = translate(&event, show.screen.window.inner_size(), self.modifiers) else { return };
        let points = panel.egui_ctx().content_rect();
        let above = Above { pointer: self.staff.feel(&signal), keys: self.staff.is_open() };
        let button = match self.visitor.press_position(&signal) {
            Some([x, y]) if !above.pointer && self.house.hears(time) => {
                self.button_at(points.lerp_inside(egui::vec2(x as f32, y as f32)))
            }
            _ => None,
        };
        let request = match button {
            // A press on a button is an input, but no breath.
            Some(request) => {
                self.visitor.note();
                Some(request)
            }
            None => {
                let staff = &self.config.staff;
                let keys = Keys {
                    staff: &staff.chord,
                    open: &staff.open,
                    mute: &staff.mute,
                    night: &staff.night,
                    blow: &self.config.controllers.key,
                    read: &self.config.controllers.read_key,
                    menu: self.menu.open,
                };
                self.house.signal(time, &mut self.visitor, &signal, (keys, above), desk)
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
        if over || self.interrupted.load(Ordering::Relaxed) {
            return events.exit();
        }
        while let Some(news) = self.shelf.news() {
            self.hear(news);
        }
        self.follow_site();
        self.follow_hours();
        self.follow_fleet();
        self.follow_workbench();
        let now = Instant::now();
        let due = now >= self.clock.next;
        if let Some(show) = self.show.as_ref().filter(|_| due) {
            show.screen.window.request_redraw();
        }
        // A compositor whose display is off asks for no picture at all: the kiosk offers one, and is alive if it is refused.
        if now >= self.clock.next + UNASKED {
            self.draw(events);
        }
        // On a graphics processor the next picture is due at once and the display's rhythm makes it wait: its word wakes the loop.
        let nap = now + NAP;
        events.set_control_flow(ControlFlow::WaitUntil(if due { nap } else { self.clock.next.min(nap) }));
    }
}

impl App<'_> {
    /// Somebody's desk and not the gallery?
    fn on_desk(&self) -> bool {
        !self.config.screen.fullscreen
    }

    /// What the simulation calls when something begins to move. A window that is gone needs no waking.
    fn wakes(&self) -> impl Fn() + Send + use<> {
        let waker = self.waker.clone();
        move || {
            let _ = waker.send_event(());
        }
    }

    /// The picture that waits because nothing moved is due at once.
    fn wake(&mut self) {
        if self.rest.rests() {
            self.clock.next = Instant::now();
        }
    }

    /// Staff hear of a device that is missing, and of its return.
    fn follow_devices(&mut self, frame: &Frame) {
        if frame.is_deaf() != self.deaf {
            self.deaf = frame.is_deaf();
            self.say(match self.deaf {
                true if frame.load.audio.input == DeviceState::Closed => "the microphone is closed".into(),
                true if frame.load.microphone.is_silent() => {
                    "the microphone is silent: muted, or its cable is out".into()
                }
                true => "no microphone: visitors press and hold to blow; `soffio doctor` says more".into(),
                false => "the microphone listens".into(),
            });
        }
        if frame.is_mute() != self.mute {
            self.mute = frame.is_mute();
            self.say(match self.mute {
                true => "no loudspeaker: the exhibit moves in silence; `soffio doctor` says more".into(),
                false => "the loudspeaker sounds".into(),
            });
        }
    }

    /// For staff, on the panel and in the log.
    fn say(&mut self, message: String) {
        tracing::info!("{message}");
        self.staff.say(self.clock.seconds(Instant::now()), message);
    }

    fn fail(&mut self, events: &ActiveEventLoop, error: String) {
        self.failure = Some(error);
        events.exit();
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
