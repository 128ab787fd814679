//! The window's part in the picture: one after another, each with what lies over it; a new device when one is lost.

use std::time::Instant;

use winit::event_loop::ActiveEventLoop;

use super::{App, Show, visit};
#[cfg(target_os = "linux")]
use crate::fleet::watchdog::Progress;
use crate::live::Frame;
use crate::pages::languages::{first, offered};
use crate::pages::menu::tiles;
use crate::pages::overlay::Scene;
use crate::staff::{Sight, Vitals};
use crate::step::stillness::PICTURE_S;
use crate::window::rest::Signs;
use crate::window::screen::{Drawn, Screen};
use crate::window::tiers::Tiers;
use crate::window::workbench::Workbench;

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

impl App<'_> {
    pub(super) fn draw(&mut self, events: &ActiveEventLoop) {
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
        // Even times are worth less than a breath that is seen at once.
        if self.sight.misses(&frame, &moment) {
            frame.set_newest(&mut moment);
        }
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
            self.languages = offered(ui.ctx(), &frame.exhibit.labels, &self.config, &self.unwritten);
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
                house: &self.house,
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
        }
        self.pictures_dark += u64::from(drawn == Drawn::Dark);
        if matches!(drawn, Drawn::Shown | Drawn::Dark) {
            #[cfg(target_os = "linux")]
            self.watchdog.tend(
                now,
                Progress {
                    pictures: self.pictures_shown + self.pictures_dark,
                    due: frame.due,
                    played: frame.load.played,
                },
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
    pub(super) fn follow_workbench(&mut self) {
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
}
