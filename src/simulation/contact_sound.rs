//! Contact sound: what two bodies do to each other while they touch, as commands to the instruments of both.
//!
//! One state for each two ends that can meet (bodies, or a body and one thing that stands still), however many points
//! and colliders they meet at. With N the force that presses, v the slip and r the speed at which the point of contact
//! runs over both surfaces:
//!
//! ```text
//!             N ≥ PRESSES                  v ≥ SLIDES
//!   apart ─────────────────→ rest ──────────────────────────→ scrape
//!     ↑                      ↑  │ r ≥ ROLLS      v ≥ SLIDES     ↑  │ v < STICKS: roll or rest, by r
//!     │              r < SETTLES└───────────→ roll ─────────────┘  │
//!     └── N < PRESSES for longer than PATIENCE steps, from each ───┘
//!
//!   hit:  in any state
//! ```
//!
//! A hit strikes; scraping and rolling slide over the bodies' surfaces; whatever lies on a body takes from its ringing.
//! Commands are sent when something is heard to change, so what lies still sends none, and however fast surfaces
//! chatter a pair strikes each instrument once in 15 ms, but for a hit that outdoes what rang (`merge`).
//!
//! Nothing allocates after [`ContactSound::new`], and all orders are fixed.

use super::merge::{Blow, Window};
use super::sonify::{Listener, place_on};
use soffio_exhibit::{Exhibit, SoundTrigger};
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_multibody::articulation::LimitKind;
use soffio_multibody::dynamics::{ContactReport, Impact, ImpactKind};
use soffio_sound::{Slide, SoundCommand, Strike, Touch};

/// Impacts softer than this make no sound, N s: a milligram at walking pace.
const SILENT: f64 = 1e-7;
/// What begins to rest faster than this is heard as a hit all the same, m/s: as much as bounces.
const AUDIBLE: f64 = 4e-3;
/// Less force is no touch, N: the weight of ten milligrams.
const PRESSES: f64 = 1e-4;
/// Steps for which a touch may be missing without being over: as joints gather or a substep is cut.
const PATIENCE: u32 = 2;
/// Slip at which scraping begins and ends, m/s: over grains of half a millimetre 40 and 20 a second, where hearing begins.
const SLIDES: f64 = 0.02;
const STICKS: f64 = 0.01;
/// Speed at which rolling begins and ends to be heard, m/s.
const ROLLS: f64 = 0.04;
const SETTLES: f64 = 0.02;
/// Part of the force that a rolling contact gives the surfaces along their plane, of what a sliding one does: coefficients
/// of rolling and sliding friction of hard bodies, about 0.01 and 0.4.
const ROLLING: f64 = 0.025;
/// Resistance per force of what lies on a body, s/m: the dashpot that dissipates as dry friction does, 4 μ/(π v̂) (Den
/// Hartog, "Mechanical Vibrations", 8.7), for μ = 0.4 and surfaces that ring at v̂ = 0.5 m/s.
const RUBS: f64 = 1.0;
/// A change of speed or force is heard from this share on, and of place on the body from this part of its half extent on.
const HEARD: f64 = 0.02;
const MOVED: f32 = 0.01;
/// The same for what damps: half a decibel a second.
const DAMPS: f64 = 0.25;
const MOVED_OFF: f32 = 0.2;
/// No pair that sounds.
const NONE: u32 = u32::MAX;

/// What contacts are heard in.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    pub exhibit: &'a Exhibit,
    pub bodies: &'a [RigidBody],
    pub listener: &'a Listener,
}

/// What two bodies do while they touch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    #[default]
    Apart,
    Rest,
    Scrape,
    Roll,
}

impl State {
    /// The state after this one at these speeds, m/s, while something presses.
    fn next(self, slip: f64, roll: f64) -> Self {
        let slides = if self == Self::Scrape { STICKS } else { SLIDES };
        let rolls = if self == Self::Roll { SETTLES } else { ROLLS };
        if slip >= slides {
            Self::Scrape
        } else if roll >= rolls {
            Self::Roll
        } else {
            Self::Rest
        }
    }
}

/// Sums over points that press, each by its force.
#[derive(Clone, Copy, Debug, Default)]
struct Pressed {
    /// N.
    force: f64,
    /// N m/s.
    slip: f64,
    roll: f64,
    /// N m.
    point: DVec3,
}

impl Pressed {
    fn add(&mut self, touch: &ContactReport) {
        let n = touch.normal_force;
        if n > 0.0 {
            self.force += n;
            self.slip += n * touch.slip.length();
            // Where one corner scrapes its point stays where it is on one of the two.
            self.roll += n * touch.roll[0].length().min(touch.roll[1].length());
            self.point += n * touch.point;
        }
    }
}

/// Two ends that can meet.
#[derive(Clone)]
struct Pair {
    /// `None` stands still.
    bodies: [Option<usize>; 2],
    state: State,
    /// Points of this step, and those that the state is taken from.
    sum: Pressed,
    last: Pressed,
    absent: u32,
    window: Window,
    active: bool,
}

impl Pair {
    /// Takes this step's points.
    fn follow(&mut self) {
        if self.sum.force >= PRESSES {
            (self.last, self.absent) = (self.sum, 0);
        } else if self.state == State::Apart {
            return;
        } else {
            self.absent += 1;
            if self.absent > PATIENCE {
                self.state = State::Apart;
                return;
            }
        }
        let Pressed { force, slip, roll, .. } = self.last;
        self.state = self.state.next(slip / force, roll / force);
    }
}

/// What an instrument of a body is told, summed over the pairs of the body, each by its force.
#[derive(Clone, Copy, Debug, Default)]
struct Told {
    force: f64,
    /// N m/s, N m and N: speed, place in the world and on the body.
    speed: f64,
    point: DVec3,
    place: [f64; 2],
}

impl Told {
    fn add(&mut self, force: f64, speed: f64, point: DVec3, place: [f32; 2]) {
        self.force += force;
        self.speed += force * speed;
        self.point += force * point;
        (0..2).for_each(|k| self.place[k] += force * f64::from(place[k]));
    }

    fn position(&self) -> [f32; 2] {
        self.place.map(|sum| (sum / self.force) as f32)
    }
}

/// What plays one sound of the exhibit: this step's sums and what was sent last.
#[derive(Clone, Copy, Default)]
struct Player {
    slides: Told,
    rests: Told,
    slide: Slide,
    touch: Option<Touch>,
}

/// All contacts of an exhibit and what is heard of them.
#[derive(Clone)]
pub struct ContactSound {
    /// The ends of each pair, ascending: bodies, behind them the colliders that stand still.
    keys: Vec<[usize; 2]>,
    pairs: Vec<Pair>,
    /// Index into `pairs` of the figure's pairs of colliders.
    of_colliders: Vec<u32>,
    /// Pairs that touch, or whose hits may wait.
    active: Vec<usize>,
    /// Indices of each body's sounds.
    of_body: Vec<Vec<usize>>,
    players: Vec<Player>,
}

impl ContactSound {
    /// Nothing touches.
    pub fn new(exhibit: &Exhibit) -> Self {
        let mut of_body = vec![Vec::new(); exhibit.bodies.len()];
        for (i, sound) in exhibit.sounds.iter().enumerate().filter(|(_, sound)| sound.on != SoundTrigger::Wind) {
            of_body[sound.body].push(i);
        }
        let meet = exhibit.pairs().meet;
        let of_pair: Vec<[usize; 2]> = meet.iter().map(|pair| key(exhibit, [pair.a, pair.b])).collect();
        let sounds = |key: &[usize; 2]| key.iter().any(|&end| of_body.get(end).is_some_and(|of| !of.is_empty()));
        let limits = exhibit.limits.iter().map(|limit| limit_key(&limit.kind));
        let mut keys: Vec<[usize; 2]> = of_pair.iter().copied().chain(limits).filter(|key| sounds(key)).collect();
        keys.sort_unstable();
        keys.dedup();
        let body = |end: usize| (end < of_body.len()).then_some(end);
        let pair = |key: &[usize; 2]| Pair {
            bodies: key.map(body),
            state: State::Apart,
            sum: Pressed::default(),
            last: Pressed::default(),
            absent: 0,
            window: Window::default(),
            active: false,
        };
        let index = |key: &[usize; 2]| keys.binary_search(key).map_or(NONE, |i| i as u32);
        Self {
            of_colliders: of_pair.iter().map(index).collect(),
            pairs: keys.iter().map(pair).collect(),
            active: Vec::with_capacity(keys.len()),
            keys,
            of_body,
            players: vec![Player::default(); exhibit.sounds.len()],
        }
    }

    /// Everything is apart again. The synth is told of what lay on a body; it falls silent by itself.
    pub fn reset(&mut self, sample: u64, out: &mut Vec<SoundCommand>) {
        for pair in self.active.drain(..) {
            let pair = &mut self.pairs[pair];
            (pair.state, pair.window, pair.active) = (State::Apart, Window::default(), false);
        }
        for player in &mut self.players {
            let lay = player.touch.take();
            out.extend(lay.map(|touch| SoundCommand::Touch(Touch { sample, resistance: 0.0, ..touch })));
            player.slide = Slide::default();
        }
    }

    /// A hit.
    pub fn hit(&mut self, impact: &Impact, sample: u64, scene: &Scene, out: &mut Vec<SoundCommand>) {
        let rests = impact.kind == ImpactKind::RestingContact;
        if impact.impulse < SILENT || (rests && (impact.speed < AUDIBLE || impact.colliders.is_none())) {
            return;
        }
        let key = impact.colliders.map_or_else(
            || sorted(impact.bodies.map(|body| body.unwrap_or(usize::MAX))),
            |colliders| key(scene.exhibit, colliders),
        );
        let Ok(index) = self.keys.binary_search(&key) else { return };
        self.wake(index);
        let pair = &mut self.pairs[index];
        let local =
            |body: Option<usize>| body.map_or(impact.point, |b| scene.bodies[b].pose().inverse_point(impact.point));
        let blow = Blow {
            sample,
            impulse: impact.impulse,
            speed: impact.speed,
            mass: impact.mass,
            points: pair.bodies.map(local),
        };
        let due = pair.window.due(sample);
        let rings = pair.window.take(blow);
        for blow in due.into_iter().chain(rings) {
            strike(&blow, pair.bodies, &self.of_body, scene, out);
        }
    }

    /// The end of a step at `sample`: what touches now.
    pub fn advance(
        &mut self,
        sample: u64,
        touching: impl Iterator<Item = ContactReport>,
        scene: &Scene,
        out: &mut Vec<SoundCommand>,
    ) {
        self.active.iter().for_each(|&pair| self.pairs[pair].sum = Pressed::default());
        for touch in touching {
            let pair = self.of_colliders[touch.pair];
            if pair != NONE {
                self.wake(pair as usize);
                self.pairs[pair as usize].sum.add(&touch);
            }
        }
        for player in &mut self.players {
            (player.slides, player.rests) = (Told::default(), Told::default());
        }
        for &index in &self.active {
            let pair = &mut self.pairs[index];
            if let Some(blow) = pair.window.due(sample) {
                strike(&blow, pair.bodies, &self.of_body, scene, out);
            }
            pair.follow();
            pair.active = pair.state != State::Apart || pair.window.is_open(sample);
            if pair.state != State::Apart {
                tell(pair, &self.of_body, &mut self.players, scene);
            }
        }
        let pairs = &self.pairs;
        self.active.retain(|&pair| pairs[pair].active);
        for (sound, player) in scene.exhibit.sounds.iter().zip(&mut self.players) {
            player.say_slide(sample, sound.instrument as u16, scene.listener, out);
            player.say_touch(sample, sound.instrument as u16, out);
        }
    }

    fn wake(&mut self, pair: usize) {
        if !self.pairs[pair].active {
            self.pairs[pair].active = true;
            self.pairs[pair].sum = Pressed::default();
            self.active.push(pair);
        }
    }
}

impl Player {
    /// Sends what has changed about what slides.
    fn say_slide(&mut self, sample: u64, instrument: u16, listener: &Listener, out: &mut Vec<SoundCommand>) {
        let last = self.slide;
        if self.slides.force == 0.0 {
            if last.force > 0.0 {
                self.slide = Slide { sample, force: 0.0, ..last };
                out.push(SoundCommand::Slide(self.slide));
            }
            return;
        }
        let (pan, distance) = listener.place(self.slides.point / self.slides.force);
        let slide = Slide {
            sample,
            instrument,
            speed: (self.slides.speed / self.slides.force) as f32,
            force: self.slides.force as f32,
            position: self.slides.position(),
            pan,
            distance,
        };
        let share = |a: f32, b: f32| differs(f64::from(a), f64::from(b), HEARD);
        let moved = |a: f32, b: f32| (a - b).abs() > MOVED;
        if share(slide.speed, last.speed)
            || share(slide.force, last.force)
            || share(slide.distance, last.distance)
            || moved(slide.pan, last.pan)
            || (0..2).any(|k| moved(slide.position[k], last.position[k]))
        {
            self.slide = slide;
            out.push(SoundCommand::Slide(slide));
        }
    }

    /// Sends what has changed about what lies on the body.
    fn say_touch(&mut self, sample: u64, instrument: u16, out: &mut Vec<SoundCommand>) {
        if self.rests.force == 0.0 {
            let lay = self.touch.take();
            out.extend(lay.map(|touch| SoundCommand::Touch(Touch { sample, resistance: 0.0, ..touch })));
            return;
        }
        let resistance = (RUBS * self.rests.force) as f32;
        let touch = Touch { sample, instrument, position: self.rests.position(), resistance };
        let changed = self.touch.is_none_or(|last| {
            let moved = (0..2).any(|k| (touch.position[k] - last.position[k]).abs() > MOVED_OFF);
            moved || differs(f64::from(resistance), f64::from(last.resistance), DAMPS)
        });
        if changed {
            self.touch = Some(touch);
            out.push(SoundCommand::Touch(touch));
        }
    }
}

/// Whether two numbers differ by more than this share of the larger.
fn differs(a: f64, b: f64, share: f64) -> bool {
    (a - b).abs() > share * a.abs().max(b.abs())
}

fn sorted([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

/// The ends of a pair of colliders: bodies, and behind them the colliders that stand still.
fn key(exhibit: &Exhibit, colliders: [usize; 2]) -> [usize; 2] {
    sorted(colliders.map(|c| exhibit.colliders[c].body.unwrap_or(exhibit.bodies.len() + c)))
}

/// The ends of a limit: bodies, and behind them the world.
fn limit_key(kind: &LimitKind) -> [usize; 2] {
    sorted(kind.bodies().map(|body| body.unwrap_or(usize::MAX)))
}

/// Strikes each of the two bodies that has a sound for it.
fn strike(blow: &Blow, bodies: [Option<usize>; 2], of_body: &[Vec<usize>], scene: &Scene, out: &mut Vec<SoundCommand>) {
    for (body, local) in bodies.into_iter().zip(blow.points) {
        let Some(body) = body else { continue };
        let (pan, distance) = scene.listener.place(scene.bodies[body].pose().point(local));
        for sound in of_body[body].iter().map(|&i| &scene.exhibit.sounds[i]).filter(|s| s.on == SoundTrigger::Impact) {
            out.push(SoundCommand::Strike(Strike {
                sample: blow.sample,
                instrument: sound.instrument as u16,
                impulse: blow.impulse as f32,
                speed: blow.speed as f32,
                mass: blow.mass as f32,
                position: place_on(scene.exhibit, sound, local),
                pan,
                distance,
            }));
        }
    }
}

/// Adds a pair that touches to what the instruments of its bodies are told. What rings from hits is damped by every
/// touch; what is scraped, by what lies still: a timbre that is scraped knows what scraping takes.
fn tell(pair: &Pair, of_body: &[Vec<usize>], players: &mut [Player], scene: &Scene) {
    let Pressed { force, slip, roll, point } = pair.last;
    let point = point / force;
    for body in pair.bodies.into_iter().flatten() {
        let local = scene.bodies[body].pose().inverse_point(point);
        for &i in &of_body[body] {
            let sound = &scene.exhibit.sounds[i];
            let place = place_on(scene.exhibit, sound, local);
            match (sound.on, pair.state) {
                (SoundTrigger::Slide, State::Scrape) => players[i].slides.add(force, slip / force, point, place),
                (SoundTrigger::Slide, State::Roll) => {
                    players[i].slides.add(ROLLING * force, roll / force, point, place)
                }
                _ => players[i].rests.add(force, 0.0, point, place),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_have_hysteresis_and_scraping_goes_first() {
        let mut state = State::Apart;
        for (slip, roll, expected) in [
            (0.015, 0.0, State::Rest),
            (0.021, 0.0, State::Scrape),
            (0.011, 1.0, State::Scrape),
            (0.009, 0.03, State::Rest),
            (0.009, 0.05, State::Roll),
            (0.009, 0.03, State::Roll),
            (0.03, 0.5, State::Scrape),
            (0.0, 0.01, State::Rest),
        ] {
            state = state.next(slip, roll);
            assert_eq!(state, expected, "slip {slip}, roll {roll} m/s");
        }
    }
}
