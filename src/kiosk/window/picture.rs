//! The window's part in the picture: one after another, each with what lies over it; a new device when one is lost.

use std::time::Instant;

use winit::event_loop::ActiveEventLoop;

use super::app::{App, Show};
use super::parts::overlaid::Overlaid;
use super::parts::pacing::Begun;
use super::parts::visit::Visit;
use super::parts::works::Works;
use super::screen::Drawn;
use super::tiers::Tiers;
use super::visit;
#[cfg(target_os = "linux")]
use crate::fleet::watchdog::Progress;
use crate::live::Frame;
use crate::pages::menu::tiles;
use crate::pages::overlay::{BreathInput, Scene, SoundState};
use crate::staff::{Sight, Vitals, Wish};
use crate::venue::house::House;
use soffio_config::Config;
use soffio_exhibit::View;
use soffio_simulation::Snapshot;

/// What one picture may count as given breath, s: after a longer pause nobody knows.
const LONGEST_GIFT: f64 = 0.5;
/// Between two pictures while the house is closed, s.
const CLOSED_S: f64 = 0.25;

impl App<'_> {
    /// Draws a picture, and looks on at what has changed since the last one.
    pub(super) fn draw(&mut self, events: &ActiveEventLoop) {
        let Some((frame, begun)) = self.begin_picture() else { return };
        let moment = self.moment(&frame, &begun);
        let Some((drawn, wishes, points)) = self.paint(&frame, &begun, &moment) else { return };
        self.count(drawn, &frame, &begun, &moment);
        self.graphics.moment = moment;
        self.follow_attract(&frame);
        self.desk.follow_devices(self.pacing.time(), &frame);
        self.follow_visit(&frame);
        self.follow_rest(events, self.pacing.clock.seconds(begun.now), points);
        let look = self.desk.panel.look(&self.setup.config);
        if let Some(show) = &self.show {
            show.live.inbox().controls.look = look;
            if let Some(shown) = self.desk.cursor() {
                show.screen.window.set_cursor_visible(shown);
            }
        }
        for wish in wishes {
            self.fulfil(events, wish, &frame);
        }
        if drawn == Drawn::DeviceLost {
            self.mend(events, &frame);
        }
    }

    /// How finely the next picture is drawn, what it is drawn from, and which time it shows.
    fn begin_picture(&mut self) -> Option<(std::sync::Arc<Frame>, Begun)> {
        let show = self.show.as_mut()?;
        let now = Instant::now();
        let (_, software) = show.screen.adapter();
        let panel = self.desk.panel.is_open();
        let open = self.house.is_open() || panel;
        let least = match (open, software) {
            (false, _) => CLOSED_S,
            (true, true) => 1.0 / self.setup.config.screen.software_fps,
            (true, false) => self.pacing.tiers.tier().least,
        };
        if let Some(tier) = self.pacing.keep_up(now, open, least, show.screen.refresh()) {
            tracing::info!(
                "pictures are drawn with {} of their pixels and {} samples from here",
                tier.finish.scale,
                tier.finish.msaa
            );
            show.screen.set_finish(tier.finish);
        }
        self.pacing.clock.rhythm.set_refresh(show.screen.refresh());
        let frame = show.live.frame();
        let page_moves = self.overlaid.overlay.is_animating() || panel;
        let begun = self.pacing.begin(now, frame.still, page_moves, least);
        Some((frame, begun))
    }

    /// What the picture shows; a breath in it is counted as given.
    fn moment(&mut self, frame: &Frame, begun: &Begun) -> Snapshot {
        let mut moment = std::mem::take(&mut self.graphics.moment);
        frame.set_moment(begun.shown, &mut moment);
        // Even times are worth less than a breath that is seen at once.
        if self.pacing.sight.misses(frame, &moment) {
            frame.set_newest(&mut moment);
        }
        if self.visit.needs.calm {
            moment.dust_particles.clear();
        }
        if moment.breath.speed > 0.0 && !frame.attracts {
            let seconds = begun.now.duration_since(begun.last).as_secs_f64().min(LONGEST_GIFT);
            self.visit.given.note(&frame.exhibit.id, jiff::Zoned::now().date(), seconds);
        }
        moment
    }

    /// Draws the work, the pages over it and the panel over all. Returns what became of it, what staff want, and the
    /// picture's size in points.
    fn paint(&mut self, frame: &Frame, begun: &Begun, moment: &Snapshot) -> Option<(Drawn, Vec<Wish>, egui::Rect)> {
        let desk = self.setup.on_desk();
        let show = self.show.as_mut()?;
        let (adapter, _) = show.screen.adapter();
        let rest = frame.exhibit.view(show.screen.aspect()).orbited(moment.turn);
        let sways = frame.attracts && !self.visit.needs.calm;
        let view = self.graphics.drift.view(rest, self.pacing.clock.seconds(begun.shown), sways);
        let vitals = Vitals {
            adapter: &adapter,
            frame_s: self.pacing.clock.frame_s,
            size: show.screen.size(),
            time: self.pacing.clock.seconds(begun.now),
            sight_s: self.pacing.sight.seconds,
        };
        let (visitor, config) = (&self.visit.visitor, &self.setup.config);
        let breathes = frame.current.breath.estimate.speed > 0.0;
        self.overlaid.menu.closes_s = config.visit.page_closes_s;
        self.overlaid.menu.update(vitals.time, visitor.activity(), breathes);
        let works: Vec<String> = self.works.offer.works().iter().map(|work| work.id.clone()).collect();
        let works: Vec<&str> = works.iter().map(String::as_str).collect();
        let mut wishes = Vec::new();
        let mut points = egui::Rect::NOTHING;
        let points_per_mm =
            |context: &egui::Context| 1.0 / (config.screen.mm_per_px as f32 * context.pixels_per_point());
        let drawn = show.screen.draw(&frame.exhibit, &view, moment, |ui| {
            points = ui.ctx().content_rect();
            let pages = Pages { frame, moment, view, time: vitals.time, points_per_mm: points_per_mm(ui.ctx()) };
            self.overlaid.paint(ui, &pages, (&mut self.works, &self.visit), (config, &self.house));
            let sight = Sight {
                frame,
                view,
                vitals,
                site: config,
                site_says: &self.setup.says,
                work_says: self.works.says.as_deref(),
                file: self.setup.file.as_ref().map(|file| file.path.as_path()),
                works: &works,
                house: &self.house,
                kept: self.fleet.kept(),
                log: &self.desk.log,
                activity: visitor.activity(),
                on_desk: desk,
                points_per_mm: pages.points_per_mm,
            };
            wishes.extend(self.desk.panel.show(ui, &sight));
        });
        Some((drawn, wishes, points))
    }

    /// Counts a picture, and tells whoever supervises the kiosk that it is alive.
    fn count(&mut self, drawn: Drawn, frame: &Frame, begun: &Begun, moment: &Snapshot) {
        self.pacing.note(drawn, begun, frame, moment);
        if drawn == Drawn::Shown && self.house.is_open() && !begun.rested {
            self.fleet.picture(begun.now.duration_since(begun.last).as_secs_f64());
        }
        #[cfg(target_os = "linux")]
        if matches!(drawn, Drawn::Shown | Drawn::Dark) {
            let counts = self.pacing.counts();
            let pictures = counts.shown + counts.dark;
            self.watchdog.tend(
                begun.now,
                Progress { pictures, due: frame.due, played: frame.load.played },
                &format!(
                    "{} on show; microphone {}; loudspeaker {}",
                    frame.exhibit.id, frame.load.audio.input, frame.load.audio.output
                ),
            );
        }
    }

    /// A new graphics device in the old window.
    fn mend(&mut self, events: &ActiveEventLoop, frame: &Frame) {
        let Some(Show { screen, live }) = self.show.take() else { return };
        let window = screen.window.clone();
        // The old surface must be gone before the window can have a new one.
        drop(screen);
        self.works.thumbnails.clear();
        match self.graphics.replace(window, &frame.exhibit) {
            Ok(screen) => {
                self.pacing.tiers = Tiers::default();
                self.show = Some(Show { screen, live });
            }
            Err(error) => self.life.fail(events, error),
        }
    }

    /// Draws with shaders that have changed; what is wrong with them is said, and the last good ones stay.
    pub(super) fn follow_workbench(&mut self) {
        let time = self.pacing.time();
        let Some(news) = self.graphics.workbench.as_mut().and_then(|workbench| workbench.news(time)) else { return };
        match (news, &mut self.show) {
            (Ok(shaders), Some(show)) => {
                show.screen.set_shaders(shaders);
                self.say("the shaders are read anew".into());
            }
            (Ok(_), None) => {}
            (Err(error), _) => self.say(format!("{error}\nThe last good shaders stay.")),
        }
    }
}

/// What the pages over a picture are drawn from, beside what the window itself owns.
struct Pages<'a> {
    frame: &'a Frame,
    moment: &'a Snapshot,
    view: View,
    time: f64,
    points_per_mm: f32,
}

impl Overlaid {
    /// Draws the pages, and begins to read aloud what was asked for.
    fn paint(
        &mut self,
        ui: &egui::Ui,
        picture: &Pages,
        (works, visit): (&mut Works, &Visit),
        (config, house): (&Config, &House),
    ) {
        let Pages { frame, time, .. } = *picture;
        self.languages.offer(ui.ctx(), &frame.exhibit, config, &self.translations);
        let language = &self.languages.shown;
        let folder = &frame.exhibit.folder;
        let tiles = tiles(ui.ctx(), works.offer.works(), &mut works.thumbnails, folder, language);
        let silent = frame.load.loudness.muted || frame.is_mute();
        let scene = Scene {
            exhibit: &frame.exhibit,
            snapshot: picture.moment,
            view: picture.view,
            attract_text: frame.attract_text.as_deref(),
            invitation_language: self.languages.inviting(frame.attracts, time),
            venue: house,
            breath_input: BreathInput {
                is_active: !frame.is_deaf() && !frame.deaf,
                is_allowed: config.visit.breath,
                has_microphone: !frame.is_deaf(),
                microphone_on: visit.listens,
            },
            sound: SoundState {
                captions: &frame.captions,
                is_muted: silent,
                reads_aloud: self.aloud.can_speak(language).then_some(self.aloud.is_on()).filter(|_| !silent),
                has_volume_control: config.volume.steps > 0 && !frame.load.loudness.muted,
            },
            seconds_blown: visit.given.of(&frame.exhibit.id),
            attract_in: frame.leaves_in,
            accessibility: visit.needs,
            dwell: visit.visitor.rests().zip(visit.dwell.share(time, config.visit.dwell_s)),
            tiles: &tiles,
            groups: &config.exhibits.groups,
            languages: &self.languages.offered,
            language,
            translations: &self.translations,
            time,
            points_per_mm: picture.points_per_mm,
        };
        if let Some(rate) = visit::rate(frame).filter(|_| scene.sound.reads_aloud.is_some()) {
            self.aloud.start_requested(&scene, rate);
        }
        let painter = ui.ctx().layer_painter(egui::LayerId::background());
        self.buttons = self.overlay.paint(&painter, ui.ctx().content_rect(), &mut self.menu, &scene);
    }
}
