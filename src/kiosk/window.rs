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
use winit::window::{Fullscreen, Window, WindowId};

use crate::audio_io::DeviceState;
use crate::config::Config;
use crate::simulation::{Command, Snapshot};

use super::aloud::Aloud;
use super::drift::Drift;
use super::dwell::Dwell;
use super::events::{is_input, translate};
use super::fleet::Fleet;
use super::given::Given;
use super::house::{Above, House};
use super::input::{Keys, Request, Visitor};
use super::languages::{first, offered};
use super::live::{self, Frame, Live, Report};
use super::log::Log;
use super::loudness::Wishes;
use super::menu::{Menu, tiles};
use super::needs::Needs;
use super::overlay::{Overlay, Scene};
use super::rest::{PICTURE_S, Rest, Signs};
use super::screen::{Drawn, Screen};
use super::shelf::{News, Offer, Places, Shelf, id};
use super::site::{Overrides, SiteFile};
use super::staff::{Sight, Staff, Vitals};
use super::tiers::Tiers;
use super::timing::{Clock, FirstSight};
use super::workbench::Workbench;

mod day;
mod fleet;
mod visit;

/// Size of the window on a desk, pixels.
const DESK_SIZE: PhysicalSize<u32> = PhysicalSize::new(1280, 720);
/// Longest sleep of the event loop: a signal, or the end of a run, is seen at the latest after this.
const NAP: Duration = Duration::from_millis(50);
/// Graphics devices that may be lost before the kiosk ends and leaves mending to whoever supervises it.
const LOST_DEVICES: u32 = 3;
/// While attract mode plays the invitation goes to the next language after so long, s: two readings of a short line.
const INVITES_S: f64 = 6.0;
/// What one picture may count as given breath, s: after a longer pause nobody knows.
const LONGEST_GIFT: f64 = 0.5;

/// Refresh of a display that does not say it, s.
const COMMON_REFRESH: f64 = 1.0 / 60.0;
/// Between two pictures while the house is closed, s.
const CLOSED_S: f64 = 0.25;

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
        deaf: false,
        mute: false,
        clock: Clock::default(),
        rest: Rest::default(),
        inputs: 0,
        waker: events.create_proxy(),
        #[cfg(target_os = "linux")]
        watchdog: super::watchdog::Watchdog::default(),
        pictures_shown: 0,
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
    language: String,
    attracts: bool,
    deaf: bool,
    mute: bool,
    clock: Clock,
    rest: Rest,
    /// Events of the window so far, but for its own pictures.
    inputs: u64,
    /// Lets the simulation end a rest.
    waker: EventLoopProxy<()>,
    #[cfg(target_os = "linux")]
    watchdog: super::watchdog::Watchdog,
    /// Pictures so far, and those after which the next one waited because nothing moved.
    pictures_shown: u64,
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
        if let Some(show) = &self.show
            && now >= self.clock.next
        {
            show.screen.window.request_redraw();
        }
        // On a graphics processor the next picture is due at once and the display's rhythm makes it wait.
        events.set_control_flow(ControlFlow::WaitUntil(self.clock.next.min(now + NAP)));
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

    fn draw(&mut self, events: &ActiveEventLoop) {
        let desk = self.on_desk();
        let Some(show) = &mut self.show else { return };
        let now = Instant::now();
        let last = self.clock.last;
        let (adapter, software) = show.screen.adapter();
        let open = self.house.is_open() || self.staff.is_open();
        let least = match (open, software) {
            (false, _) => CLOSED_S,
            (true, true) => 1.0 / self.config.screen.software_fps,
            (true, false) => self.tiers.tier().least,
        };
        let asked = least.max(show.screen.refresh().unwrap_or(COMMON_REFRESH));
        // The way to a picture that had time says nothing of the machine.
        let rested = self.rest.rests();
        if open && !rested && self.tiers.note(now.duration_since(last).as_secs_f64(), asked) {
            let tier = self.tiers.tier();
            tracing::info!(
                "pictures are drawn with {} of their pixels and {} samples from here",
                tier.finish.scale,
                tier.finish.msaa
            );
            show.screen.set_finish(tier.finish);
        }
        self.clock.rhythm.set_refresh(show.screen.refresh());
        let frame = show.live.frame();
        let signs =
            Signs { still: frame.still, page_moves: self.overlay.moves() || self.staff.is_open(), inputs: self.inputs };
        let rests = self.rest.note(self.clock.seconds(now), signs);
        let shown = self.clock.tick(now, if rests { least.max(PICTURE_S) } else { least });
        let mut moment = std::mem::take(&mut self.moment);
        frame.set_moment(shown, &mut moment);
        if self.needs.calm {
            moment.motes.clear();
        }
        if moment.breath.speed > 0.0 && !frame.attracts {
            let seconds = now.duration_since(last).as_secs_f64().min(LONGEST_GIFT);
            self.given.note(&frame.exhibit.id, jiff::Zoned::now().date(), seconds);
        }
        let rest = frame.exhibit.view(show.screen.aspect()).turned(moment.turn);
        let sways = frame.attracts && !self.needs.calm;
        let view = self.drift.view(rest, self.clock.seconds(shown), sways);
        let size = show.screen.size();
        let vitals = Vitals {
            adapter: &adapter,
            frame_s: self.clock.frame_s,
            size,
            time: self.clock.seconds(now),
            sight_s: self.sight.seconds,
        };
        self.menu.tend(vitals.time, self.visitor.activity(), frame.current.breath.estimate.speed > 0.0);
        let works: Vec<String> = self.offer.works().iter().map(|work| work.id.clone()).collect();
        let works: Vec<&str> = works.iter().map(String::as_str).collect();
        let mut wishes = Vec::new();
        let mut points = egui::Rect::NOTHING;
        let silent = frame.load.loudness.muted || frame.is_mute();
        let drawn = show.screen.draw(&frame.exhibit, &view, &moment, |ui| {
            self.languages = offered(ui.ctx(), &frame.exhibit.labels, &self.config);
            if !self.languages.contains(&self.language) {
                self.language = first(&self.languages, &frame.exhibit.labels, &self.config);
            }
            let tiles = tiles(ui.ctx(), self.offer.works(), &mut self.pictures, &frame.exhibit.folder, &self.language);
            let turn = (vitals.time / INVITES_S) as usize % self.languages.len().max(1);
            let inviting = if frame.attracts { self.languages.get(turn) } else { None };
            let scene = Scene {
                exhibit: &frame.exhibit,
                moment: &moment,
                view,
                attract_text: frame.attract_text.as_deref(),
                inviting: inviting.unwrap_or(&self.language),
                hears: !frame.is_deaf() && !frame.deaf,
                breath: self.config.visit.breath,
                has_ear: !frame.is_deaf(),
                listens: self.listens,
                captions: &frame.captions,
                given: self.given.of(&frame.exhibit.id),
                silent,
                leaves_in: frame.leaves_in,
                needs: self.needs,
                rests: self.visitor.rests().zip(self.dwell.share(vitals.time, self.config.visit.dwell_s)),
                speech: self.aloud.can_speak(&self.language).then_some(self.aloud.is_on()).filter(|_| !silent),
                tiles: &tiles,
                groups: &self.config.exhibits.groups,
                languages: &self.languages,
                language: &self.language,
                volume: self.config.volume.steps > 0 && !frame.load.loudness.muted,
                time: vitals.time,
                points_per_mm: 1.0 / (self.config.screen.mm_per_px as f32 * ui.ctx().pixels_per_point()),
            };
            if let Some(rate) = visit::rate(&frame).filter(|_| scene.speech.is_some()) {
                self.aloud.follow(&scene, rate);
            }
            let painter = ui.ctx().layer_painter(egui::LayerId::background());
            points = ui.ctx().content_rect();
            self.buttons = self.overlay.paint(&painter, ui.ctx().content_rect(), &mut self.menu, &scene);
            if day::cover(&painter, &self.house, &scene) {
                self.buttons.clear();
            }
            let sight = Sight {
                frame: &frame,
                view,
                vitals,
                site: &self.config,
                site_says: &self.site_says,
                work_says: self.work_says.as_deref(),
                file: self.site.as_ref().map(|site| site.path.as_path()),
                works: &works,
                house: &self.house,
                kept: self.fleet.kept(),
                log: &self.log,
                activity: self.visitor.activity(),
                on_desk: desk,
                points_per_mm: scene.points_per_mm,
            };
            wishes.extend(self.staff.show(ui, &sight));
        });
        if drawn == Drawn::Shown {
            self.sight.note(&frame, &moment, now);
            self.pictures_shown += 1;
            self.pictures_at_rest += u64::from(rests);
            if self.house.is_open() && !rested {
                self.fleet.picture(now.duration_since(last).as_secs_f64());
            }
            #[cfg(target_os = "linux")]
            self.watchdog.tend(
                now,
                super::watchdog::Progress { pictures: self.pictures_shown, due: frame.due, played: frame.load.played },
                &format!(
                    "{} on show; microphone {}; loudspeaker {}",
                    frame.exhibit.id, frame.load.audio.input, frame.load.audio.output
                ),
            );
        }
        self.moment = moment;
        self.follow_attract(&frame);
        self.follow_devices(&frame);
        self.follow_visit(&frame);
        self.follow_rest(events, vitals.time, points);
        let (look, open) = (self.staff.look(&self.config), self.staff.is_open());
        if let Some(show) = &self.show {
            show.live.controls().look = look;
            if self.cursor != open {
                show.screen.window.set_cursor_visible(open);
            }
        }
        self.cursor = open;
        for wish in wishes {
            self.fulfil(events, wish, &frame);
        }
        if drawn == Drawn::DeviceLost {
            self.mend(events, &frame);
        }
    }

    /// A new graphics device in the old window.
    fn mend(&mut self, events: &ActiveEventLoop, frame: &Frame) {
        let Some(Show { screen, live }) = self.show.take() else { return };
        let window = screen.window.clone();
        // The old surface must be gone before the window can have a new one.
        drop(screen);
        self.pictures.clear();
        self.lost += 1;
        if self.lost > LOST_DEVICES {
            return self.fail(events, format!("the graphics device was lost {} times", self.lost));
        }
        match Screen::new(self.instance.clone(), window, &frame.exhibit) {
            Ok(screen) => {
                tracing::info!("a new graphics device draws in the old window: {}", screen.adapter().0);
                self.tiers = Tiers::default();
                self.workbench = self.workbench.take().map(Workbench::again);
                self.show = Some(Show { screen, live });
            }
            Err(error) => self.fail(events, error),
        }
    }

    /// Draws with shaders that have changed; what is wrong with them is said, and the last good ones stay.
    fn follow_workbench(&mut self) {
        let time = self.clock.seconds(Instant::now());
        let Some(news) = self.workbench.as_mut().and_then(|workbench| workbench.news(time)) else { return };
        match (news, &mut self.show) {
            (Ok(shaders), Some(show)) => {
                show.screen.set_shaders(shaders);
                self.say("the shaders are read anew".into());
            }
            (Ok(_), None) => {}
            (Err(error), _) => self.say(format!("{error}\nThe last good shaders stay.")),
        }
    }

    /// What the shelf has to say.
    fn hear(&mut self, news: News) {
        match news {
            News::Show(exhibit) => {
                self.turning = false;
                self.work_says = None;
                self.fleet.read_anew(true, None);
                self.given.leave();
                self.needs.round = false;
                self.say(format!("{} is on show", exhibit.id));
                if let Some(show) = &mut self.show {
                    show.screen.prepare(&exhibit);
                    show.live.controls().exhibit = Some(exhibit);
                }
                self.tell();
            }
            News::Failed(report) => {
                self.turning = false;
                self.fleet.read_anew(false, None);
                self.say(format!("{}\nThe last good exhibit stays on show.", report.trim_end()));
            }
            News::Stands(work) => {
                self.pictures.retain(|(id, _)| *id != work.id);
                self.offer.put(*work);
            }
            News::Falls(id, report) => {
                self.offer.remove(&id);
                let shown = self.show.as_ref().map(|show| show.live.frame().exhibit.folder.clone());
                if shown.is_some_and(|folder| super::shelf::id(&folder) == id) {
                    self.fleet.read_anew(false, None);
                    self.work_says = Some(report.trim_end().to_owned());
                }
                self.say(format!("{}\n{id} is not offered until it is mended.", report.trim_end()));
            }
            News::Gone(id) => self.offer.remove(&id),
        }
    }

    /// Asks for the work so many places after the one on show; says whether there is another.
    fn leaf(&self, by: i32) -> bool {
        let Some(show) = &self.show else { return false };
        let shown = id(&show.live.frame().exhibit.folder);
        let next = self.offer.beside(&shown, by as isize);
        next.inspect(|work| self.shelf.show(&work.folder)).is_some()
    }

    /// When the last visitor has left, the next one finds everything as it was first; meanwhile the works take turns.
    fn follow_attract(&mut self, frame: &Frame) {
        if frame.attracts && !self.attracts {
            self.visitor.leave();
            self.language.clear();
            (self.menu, self.listens) = (Menu::default(), true);
            self.forget_needs();
            self.given.leave();
            self.tell();
        }
        if frame.attracts && frame.attract_rounds > 0 && !self.turning {
            self.turning = self.leaf(1);
        }
        self.attracts = frame.attracts;
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

    /// What a press at a point of the picture asks for, where it is not a breath.
    fn button_at(&self, at: egui::Pos2) -> Option<Request> {
        self.buttons.iter().find(|(rect, _)| rect.contains(at)).map(|&(_, request)| request)
    }

    fn grant(&mut self, events: &ActiveEventLoop, request: Request) {
        match request {
            Request::Close => events.exit(),
            Request::Language(index) => self.language = self.languages.get(index).cloned().unwrap_or_default(),
            Request::NextLanguage => {
                let shown = self.languages.iter().position(|code| *code == self.language);
                let next = shown.map_or(0, |shown| (shown + 1) % self.languages.len());
                self.language = self.languages.get(next).cloned().unwrap_or_default();
            }
            Request::Menu => {
                self.menu.toggle();
                self.visitor.let_go();
            }
            Request::Work(index) => {
                if let Some(work) = self.offer.works().get(index) {
                    self.shelf.show(&work.folder);
                }
                self.menu.open = false;
            }
            Request::Leaf(by) if self.menu.open => self.menu.turn(by),
            Request::Leaf(by) => {
                self.leaf(by);
            }
            Request::Large => self.needs.reading.large ^= true,
            Request::Contrast => self.needs.reading.contrast ^= true,
            Request::Listen => self.listens = !self.listens,
            Request::PressOnce | Request::Dwell | Request::Calm | Request::Round | Request::Speak => {
                self.choose(request);
            }
            Request::Look(way) => {
                self.menu.look(way, &self.buttons);
                self.aloud.reach(self.menu.marked(&self.buttons));
            }
            Request::Enter => {
                if let Some(marked) = self.menu.marked(&self.buttons).filter(|request| *request != Request::Enter) {
                    self.grant(events, marked);
                }
            }
            Request::Nothing => {}
            Request::Louder(steps) => self.wish(|wishes| wishes.louder += steps),
            Request::Mute => self.wish(|wishes| wishes.mutes += 1),
            Request::Night => self.wish(|wishes| wishes.nights += 1),
            Request::Open => self.open_early(),
            Request::ToggleStaff => {
                self.staff.toggle();
                self.visitor.let_go();
            }
        }
    }

    /// Tells the simulation what the visitor does.
    fn tell(&mut self) {
        let lifts = self.visitor.lifts();
        let Some(show) = &self.show else { return };
        let mut controls = show.live.controls();
        controls.aim = self.visitor.aim();
        controls.stick = self.visitor.stick().map(|tilt| tilt * self.config.controllers.stick_speed);
        controls.hold = self.visitor.holds_key();
        controls.presses.clear();
        controls.presses.extend(self.visitor.presses());
        controls.lifts.extend(lifts);
        controls.keyed = self.visitor.keyed();
        controls.press_once = self.needs.once() && !self.menu.open;
        (controls.calm, controls.round) = (self.needs.calm, self.needs.round);
        controls.activity = self.visitor.activity();
        controls.deaf = !self.listens;
        controls.closed = !self.house.is_open();
        controls.inert = !self.house.hears(self.clock.seconds(Instant::now()));
    }

    /// Asks something of the loudness.
    fn wish(&self, change: impl FnOnce(&mut Wishes)) {
        if let Some(show) = &self.show {
            change(&mut show.live.controls().loudness);
        }
    }

    fn command(&self, command: Command) {
        if let Some(show) = &self.show {
            show.live.controls().commands.push(command);
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
    let plain = Window::default_attributes().with_title("Soffio").with_inner_size(DESK_SIZE);
    let attributes = match on_desk {
        true => plain,
        false => plain.with_decorations(false).with_fullscreen(Some(Fullscreen::Borderless(None))),
    };
    let window = events.create_window(attributes).map_err(|error| error.to_string())?;
    window.set_cursor_visible(false);
    Ok(Arc::new(window))
}
