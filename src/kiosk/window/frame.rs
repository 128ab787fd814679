//! Draws the frames, each with its overlays, and replaces a lost graphics device.

use std::time::Instant;

use winit::event_loop::ActiveEventLoop;

use super::app::{App, WindowAndSimulation};
use super::parts::exhibits::ExhibitSelection;
use super::parts::overlays::Overlays;
use super::parts::pacing::{FrameMotion, FrameStart};
use super::parts::visit::VisitState;
use super::quality_tiers::QualityController;
use super::screen::Drawn;
use super::visit;
#[cfg(target_os = "linux")]
use crate::fleet::watchdog::Progress;
use crate::live::LiveState;
use crate::pages::menu::tiles;
use crate::pages::overlay::{BreathInput, Scene, SoundState};
use crate::staff::{PanelInput, StaffAction, WindowStats};
#[cfg(target_os = "linux")]
use crate::venue::catalog::STUCK;
use crate::venue::site::ConfigWatcher;
use crate::venue::state::VenueState;
use soffio_config::Config;
use soffio_exhibit::View;
use soffio_simulation::Snapshot;

/// Longest breath time that one frame may count, s.
const LONGEST_GIFT: f64 = 0.5;
/// Time between two frames while the venue is closed, s.
const CLOSED_S: f64 = 0.25;

/// A frame that was drawn.
struct Painted {
    /// What became of it.
    drawn: Drawn,
    /// Actions of staff on the panel.
    actions: Vec<StaffAction>,
    /// The picture, points.
    points: egui::Rect,
}

impl App<'_> {
    /// Draws a frame, and updates everything that changes once a frame.
    pub(super) fn draw(&mut self, events: &ActiveEventLoop) {
        let Some((frame, begun)) = self.begin_frame() else { return };
        let moment = self.moment(&frame, &begun);
        let Some(Painted { drawn, actions, points }) = self.paint(&frame, &begun, &moment) else { return };
        self.count(drawn, &frame, &begun, &moment);
        self.exhibits.loader.list();
        self.graphics.moment = moment;
        self.update_attract(&frame);
        self.desk.report_devices(self.pacing.time(), &frame);
        self.update_visit(&frame);
        self.update_dwell(events, self.pacing.clock.seconds(begun.now), points);
        let look = self.desk.panel.inspection(&self.setup.config);
        if let Some(show) = &self.show {
            show.live.inbox().controls.look = look;
            if let Some(shown) = self.desk.cursor() {
                show.screen.window.set_cursor_visible(shown);
            }
        }
        for action in actions {
            self.apply_staff_action(events, action, &frame);
        }
        if drawn == Drawn::DeviceLost {
            self.replace_device(events, &frame);
        }
    }

    /// Chooses the quality of the next frame, its state, and the time that it shows.
    fn begin_frame(&mut self) -> Option<(std::sync::Arc<LiveState>, FrameStart)> {
        let show = self.show.as_mut()?;
        let now = Instant::now();
        let (_, software) = show.screen.adapter();
        let panel = self.desk.panel.is_open();
        let open = self.venue.is_open() || panel;
        let least = match (open, software) {
            (false, _) => CLOSED_S,
            (true, true) => 1.0 / self.setup.config.screen.software_fps,
            (true, false) => self.pacing.quality.tier().least,
        };
        if let Some(tier) = self.pacing.adapt_quality(now, open, least, show.screen.refresh()) {
            tracing::info!("rendering scale {}, {} samples a pixel from here", tier.finish.scale, tier.finish.msaa);
            show.screen.set_finish(tier.finish);
        }
        self.pacing.clock.pacer.set_refresh(show.screen.refresh());
        let frame = show.live.frame();
        let page_moves = self.overlays.overlay.is_animating() || panel;
        let begun = self.pacing.begin(now, FrameMotion { still: frame.still, page_moves }, least);
        Some((frame, begun))
    }

    /// State that the frame shows; a breath in it adds to the breath time.
    fn moment(&mut self, frame: &LiveState, begun: &FrameStart) -> Snapshot {
        let mut moment = std::mem::take(&mut self.graphics.moment);
        frame.interpolate(begun.shown, &mut moment);
        // The first frame of a breath shows the newest step: low latency matters more than even times.
        if self.pacing.onset_latency.misses(frame, &moment) {
            frame.copy_newest(&mut moment);
        }
        if self.visit.accessibility.reduced_motion {
            moment.dust_particles.clear();
        }
        if moment.breath.speed > 0.0 && !frame.attracts {
            let seconds = begun.now.duration_since(begun.last).as_secs_f64().min(LONGEST_GIFT);
            self.visit.breath_time.add(&frame.exhibit.id, jiff::Zoned::now().date(), seconds);
        }
        moment
    }

    /// Draws the exhibit, the pages over it and the staff panel. `None` without a window.
    fn paint(&mut self, frame: &LiveState, begun: &FrameStart, moment: &Snapshot) -> Option<Painted> {
        let desk = self.setup.on_desk();
        let show = self.show.as_mut()?;
        let (adapter, _) = show.screen.adapter();
        let rest = frame.exhibit.view(show.screen.aspect()).orbited(moment.turn);
        let sways = frame.attracts && !self.visit.accessibility.reduced_motion;
        let view = self.graphics.camera_sway.view(rest, self.pacing.clock.seconds(begun.shown), sways);
        let vitals = WindowStats {
            adapter: &adapter,
            frame_s: self.pacing.clock.frame_s,
            size: show.screen.size(),
            time: self.pacing.clock.seconds(begun.now),
            onset_latency_s: self.pacing.onset_latency.seconds,
        };
        let (visitor, config) = (&self.visit.visitor, &self.setup.config);
        let breathes = frame.current.breath.estimate.speed > 0.0;
        self.overlays.menu.closes_s = config.visit.page_closes_s;
        self.overlays.menu.update(vitals.time, visitor.activity(), breathes);
        let exhibit_ids: Vec<String> = self.exhibits.offer.entries().iter().map(|exhibit| exhibit.id.clone()).collect();
        let exhibit_ids: Vec<&str> = exhibit_ids.iter().map(String::as_str).collect();
        let mut actions = Vec::new();
        let mut points = egui::Rect::NOTHING;
        let points_per_mm =
            |context: &egui::Context| 1.0 / (config.screen.mm_per_px as f32 * context.pixels_per_point());
        let drawn = show.screen.draw(&frame.exhibit, &view, moment, |ui| {
            points = ui.ctx().content_rect();
            let pages = Pages { frame, moment, view, time: vitals.time, points_per_mm: points_per_mm(ui.ctx()) };
            self.overlays.paint(ui, &pages, &mut self.exhibits, &self.visit, config, &self.venue);
            let input = PanelInput {
                frame,
                view,
                vitals,
                site: config,
                config_problems: &self.setup.problems,
                exhibit_problem: self.exhibits.problem.as_deref(),
                file: self.setup.file.as_ref().map(ConfigWatcher::saved_in),
                exhibit_ids: &exhibit_ids,
                venue: &self.venue,
                persisted: self.fleet.persisted(),
                log: &self.desk.log,
                texts: self.overlays.languages.staff(config, &self.overlays.translations),
                activity: visitor.activity(),
                on_desk: desk,
                points_per_mm: pages.points_per_mm,
            };
            actions.extend(self.desk.panel.show(ui, &input));
        });
        Some(Painted { drawn, actions, points })
    }

    /// Counts a frame, and sends the keep-alive to systemd.
    fn count(&mut self, drawn: Drawn, frame: &LiveState, begun: &FrameStart, moment: &Snapshot) {
        self.pacing.record(drawn, begun, frame, moment);
        if drawn == Drawn::Shown && self.venue.is_open() && !begun.rested {
            self.fleet.record_frame(begun.now.duration_since(begun.last).as_secs_f64());
        }
        #[cfg(target_os = "linux")]
        if matches!(drawn, Drawn::Shown | Drawn::Dark) {
            let counts = self.pacing.counts();
            let pictures = counts.shown + counts.dark;
            let loading = self.exhibits.loader.busy_for();
            let loader_stuck = loading.is_some_and(|time| time > STUCK);
            let stuck = if loader_stuck { "; the loader of exhibits is stuck" } else { "" };
            self.watchdog.update(
                begun.now,
                Progress { pictures, due: frame.due, played: frame.load.played, loader_stuck },
                &format!(
                    "{} on show; microphone {}; loudspeaker {}{stuck}",
                    frame.exhibit.id, frame.load.audio.input, frame.load.audio.output
                ),
            );
        }
    }

    /// Opens a new graphics device in the old window.
    fn replace_device(&mut self, events: &ActiveEventLoop, frame: &LiveState) {
        let Some(WindowAndSimulation { screen, live }) = self.show.take() else { return };
        let window = screen.window.clone();
        // The old surface must be gone before the window can have a new one.
        drop(screen);
        self.exhibits.thumbnails.clear();
        match self.graphics.replace(window, &frame.exhibit) {
            Ok(screen) => {
                self.pacing.quality = QualityController::default();
                self.show = Some(WindowAndSimulation { screen, live });
            }
            Err(error) => self.life.fail(events, error),
        }
    }

    /// Takes over changed shaders. Invalid ones are reported, and the last valid ones stay.
    pub(super) fn update_shaders(&mut self) {
        let time = self.pacing.time();
        let Some(news) =
            self.graphics.shader_watcher.as_mut().and_then(|shader_watcher| shader_watcher.reload_if_changed(time))
        else {
            return;
        };
        match (news, &mut self.show) {
            (Ok(shaders), Some(show)) => {
                show.screen.set_shaders(shaders);
                self.say("the shaders are reloaded".into());
            }
            (Ok(_), None) => {}
            (Err(error), _) => self.say(format!("{error}\nThe last valid shaders stay.")),
        }
    }
}

/// Inputs of the pages over a frame, besides the state of the window.
struct Pages<'a> {
    frame: &'a LiveState,
    moment: &'a Snapshot,
    view: View,
    time: f64,
    points_per_mm: f32,
}

impl Overlays {
    /// Draws the pages, and starts a requested reading.
    fn paint(
        &mut self,
        ui: &egui::Ui,
        picture: &Pages,
        exhibits: &mut ExhibitSelection,
        visit: &VisitState,
        config: &Config,
        venue: &VenueState,
    ) {
        let Pages { frame, time, .. } = *picture;
        self.languages.offer(ui.ctx(), &frame.exhibit, config, &self.translations);
        let language = &self.languages.shown;
        let folder = &frame.exhibit.folder;
        let tiles = tiles(ui.ctx(), exhibits.offer.entries(), &mut exhibits.thumbnails, folder, language);
        let silent = frame.load.loudness.muted || frame.lacks_output();
        let scene = Scene {
            exhibit: &frame.exhibit,
            snapshot: picture.moment,
            view: picture.view,
            attract_text: frame.attract_text.as_deref(),
            invitation_language: self.languages.inviting(frame.attracts, time),
            venue,
            breath_input: BreathInput {
                is_active: !frame.lacks_microphone() && !frame.ignore_microphone,
                is_allowed: config.visit.breath,
                has_microphone: !frame.lacks_microphone(),
                microphone_on: visit.microphone_on,
            },
            sound: SoundState {
                captions: &frame.captions,
                is_muted: silent,
                reads_aloud: self.read_aloud.can_speak(language).then_some(self.read_aloud.is_on()).filter(|_| !silent),
                has_volume_control: config.volume.steps > 0 && !frame.load.loudness.muted,
            },
            seconds_blown: visit.breath_time.of(&frame.exhibit.id),
            attract_in: frame.leaves_in,
            accessibility: visit.accessibility,
            dwell: visit.visitor.resting_pointer().zip(visit.dwell.progress(time, config.visit.dwell_s)),
            tiles: &tiles,
            groups: &config.exhibits.groups,
            languages: &self.languages.offered,
            language,
            translations: &self.translations,
            time,
            points_per_mm: picture.points_per_mm,
        };
        if let Some(rate) = visit::rate(frame).filter(|_| scene.sound.reads_aloud.is_some()) {
            self.read_aloud.start_requested(&scene, rate);
        }
        let painter = ui.ctx().layer_painter(egui::LayerId::background());
        self.buttons = self.overlay.paint(&painter, ui.ctx().content_rect(), &mut self.menu, &scene);
    }
}
