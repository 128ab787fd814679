//! Contact sound: a state machine of each contact pair, which sends commands to the instruments of both bodies.
//!
//! A pair is two ends that can collide (bodies, or a body and one fixed collider), however many points and colliders they
//! touch at. With N the normal force, v the slip speed and r the speed at which the contact point moves over both surfaces:
//!
//! ```text
//!             N ≥ least_force              v ≥ scrape.on
//!   apart ─────────────────→ rest ──────────────────────────→ scrape
//!     ↑                      ↑  │ r ≥ roll.on    v ≥ scrape.on  ↑  │ v < scrape.off: roll or rest, by r
//!     │            r < roll.off └───────────→ roll ─────────────┘  │
//!     └── N < least_force for longer than release_steps, from each ┘
//!
//!   impact:  in any state
//! ```
//!
//! An impact strikes; scraping and rolling excite the bodies' surfaces; every contact damps the modes of its body.
//! A command is sent on an audible change, so a body at rest sends none. However fast surfaces chatter, a pair strikes each
//! instrument once in 15 ms, except for a much louder impact (`impact_merge`).
//!
//! Nothing allocates after [`ContactSound::new`], and all orders are fixed.

use super::impact_merge::{ImpactPulse, MergeWindow};
use super::sonify::{AudioListener, strike_position};
use soffio_exhibit::{Exhibit, SoundBinding, SoundTrigger};
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_multibody::articulation::LimitKind;
use soffio_multibody::dynamics::{ContactReport, Impact, ImpactKind};
use soffio_sound::{Damp, Slide, SoundCommand, SoundSurface, Strike};

/// Two thresholds of a state with hysteresis, m/s.
struct Hysteresis {
    /// The state begins here.
    on: f64,
    /// It ends below this.
    off: f64,
}

/// Thresholds of impacts and contact states.
struct ContactTuning {
    /// Least impulse of an impact that sounds, N s: a milligram at walking pace.
    least_impulse: f64,
    /// Least approach speed at which a new resting contact sounds as an impact, m/s: that of bodies that bounce.
    least_speed: f64,
    /// Least force of a contact, N: the weight of ten milligrams.
    least_force: f64,
    /// Steps for which a contact may be missing without ending, as during assembly or when a substep is cut.
    release_steps: u32,
    /// Slip speed of scraping: over grains of half a millimetre 40 and 20 a second, where hearing begins.
    scrape: Hysteresis,
    /// Speed of audible rolling.
    roll: Hysteresis,
    /// Tangential force of a rolling contact over that of a sliding one: coefficients of rolling and sliding friction of hard
    /// bodies, about 0.01 and 0.4.
    rolling_share: f64,
    /// Damping resistance of a resting contact per force, s/m: the dashpot that dissipates as dry friction does, 4 μ/(π v̂)
    /// (Den Hartog, "Mechanical Vibrations", 8.7), for μ = 0.4 and surfaces that vibrate at v̂ = 0.5 m/s.
    resistance_per_force: f64,
}

const CONTACT: ContactTuning = ContactTuning {
    least_impulse: 1e-7,
    least_speed: 4e-3,
    least_force: 1e-4,
    release_steps: 2,
    scrape: Hysteresis { on: 0.02, off: 0.01 },
    roll: Hysteresis { on: 0.04, off: 0.02 },
    rolling_share: 0.025,
    resistance_per_force: 1.0,
};

/// Least changes that are sent.
struct AudibleChange {
    /// Of speed, force or resistance, as a share of the larger value.
    level: f64,
    /// Of a position on the body, as a share of its half extent.
    position: f32,
}

const SLIDE_CHANGE: AudibleChange = AudibleChange { level: 0.02, position: 0.01 };
/// A quarter more resistance changes the decay by half a decibel a second.
const DAMP_CHANGE: AudibleChange = AudibleChange { level: 0.25, position: 0.2 };
/// Index of no pair.
const NONE: u32 = u32::MAX;

/// Bodies and listener at one moment.
#[derive(Clone, Copy)]
pub struct SoundScene<'a> {
    /// The exhibit.
    pub exhibit: &'a Exhibit,
    /// Present state of all bodies.
    pub bodies: &'a [RigidBody],
    /// Position of the listener.
    pub listener: &'a AudioListener,
}

/// State of a contact pair.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum ContactState {
    #[default]
    Apart,
    Rest,
    Scrape,
    Roll,
}

impl ContactState {
    /// The next state at these speeds, m/s, while there is a normal force.
    fn next(self, slip: f64, roll: f64) -> Self {
        let scrape_threshold = if self == Self::Scrape { CONTACT.scrape.off } else { CONTACT.scrape.on };
        let roll_threshold = if self == Self::Roll { CONTACT.roll.off } else { CONTACT.roll.on };
        if slip >= scrape_threshold {
            Self::Scrape
        } else if roll >= roll_threshold {
            Self::Roll
        } else {
            Self::Rest
        }
    }
}

/// Sums over the contact points of a pair, weighted by normal force.
#[derive(Clone, Copy, Debug, Default)]
struct PairSum {
    /// N.
    force: f64,
    /// N m/s.
    slip: f64,
    /// N m/s.
    roll: f64,
    /// N m.
    point: DVec3,
}

impl PairSum {
    fn add(&mut self, touch: &ContactReport) {
        let n = touch.normal_force;
        if n > 0.0 {
            self.force += n;
            self.slip += n * touch.slip.length();
            // Where one corner scrapes, its point does not move on one of the two surfaces.
            self.roll += n * touch.roll[0].length().min(touch.roll[1].length());
            self.point += n * touch.point;
        }
    }
}

/// A contact pair: two ends that can collide.
#[derive(Clone)]
struct ContactPair {
    /// `None` is fixed.
    bodies: [Option<usize>; 2],
    state: ContactState,
    /// Of this step.
    sum: PairSum,
    /// Of the last step with a contact.
    last: PairSum,
    /// Steps without a contact.
    absent: u32,
    window: MergeWindow,
    active: bool,
}

impl ContactPair {
    /// Updates the state from the sums of this step.
    fn update_state(&mut self) {
        if self.sum.force >= CONTACT.least_force {
            (self.last, self.absent) = (self.sum, 0);
        } else if self.state == ContactState::Apart {
            return;
        } else {
            self.absent += 1;
            if self.absent > CONTACT.release_steps {
                self.state = ContactState::Apart;
                return;
            }
        }
        let PairSum { force, slip, roll, .. } = self.last;
        self.state = self.state.next(slip / force, roll / force);
    }
}

/// Sums over the pairs of a body for one of its instruments, weighted by force.
#[derive(Clone, Copy, Debug, Default)]
struct InstrumentSum {
    /// N.
    force: f64,
    /// N m/s.
    speed: f64,
    /// World, N m.
    point: DVec3,
    /// On the body, N.
    position: [f64; 2],
}

/// One contact as it acts on an instrument.
struct InstrumentContact {
    /// N.
    force: f64,
    /// m/s.
    speed: f64,
    /// World, m.
    point: DVec3,
    /// On the body, −1…1.
    position: [f32; 2],
}

impl InstrumentSum {
    fn add(&mut self, contact: InstrumentContact) {
        let InstrumentContact { force, speed, point, position } = contact;
        self.force += force;
        self.speed += force * speed;
        self.point += force * point;
        (0..2).for_each(|k| self.position[k] += force * f64::from(position[k]));
    }

    /// Mean position on the body, −1…1.
    fn mean_position(&self) -> [f32; 2] {
        self.position.map(|sum| (sum / self.force) as f32)
    }
}

/// State of one sound of the exhibit: this step's sums and the commands last sent.
#[derive(Clone, Copy, Default)]
struct SoundState {
    sliding: InstrumentSum,
    damping: InstrumentSum,
    slide: Slide,
    damp: Option<Damp>,
}

/// All contact pairs of an exhibit and their sounds.
#[derive(Clone)]
pub struct ContactSound {
    /// The ends of each pair, ascending: bodies, then fixed colliders.
    keys: Vec<[usize; 2]>,
    pairs: Vec<ContactPair>,
    /// Index into `pairs` of each pair of colliders.
    of_colliders: Vec<u32>,
    /// Pairs in contact, or with an open merge window.
    active: Vec<usize>,
    /// Indices of each body's sounds.
    of_body: Vec<Vec<usize>>,
    sounds: Vec<SoundState>,
}

impl ContactSound {
    /// All pairs apart.
    pub fn new(exhibit: &Exhibit) -> Self {
        let mut of_body = vec![Vec::new(); exhibit.bodies.len()];
        let touched = |sound: &SoundBinding| sound.is_struck || sound.on == SoundTrigger::Slide;
        for (i, sound) in exhibit.sounds.iter().enumerate().filter(|(_, sound)| touched(sound)) {
            of_body[sound.body].push(i);
        }
        let meet = exhibit.collider_pairs().meet;
        let of_pair: Vec<[usize; 2]> = meet.iter().map(|pair| key(exhibit, [pair.a, pair.b])).collect();
        let sounds = |key: &[usize; 2]| key.iter().any(|&end| of_body.get(end).is_some_and(|of| !of.is_empty()));
        let limits = exhibit.limits.iter().map(|limit| limit_key(&limit.kind));
        let mut keys: Vec<[usize; 2]> = of_pair.iter().copied().chain(limits).filter(|key| sounds(key)).collect();
        keys.sort_unstable();
        keys.dedup();
        let body = |end: usize| (end < of_body.len()).then_some(end);
        let pair = |key: &[usize; 2]| ContactPair {
            bodies: key.map(body),
            state: ContactState::Apart,
            sum: PairSum::default(),
            last: PairSum::default(),
            absent: 0,
            window: MergeWindow::default(),
            active: false,
        };
        let index = |key: &[usize; 2]| keys.binary_search(key).map_or(NONE, |i| i as u32);
        Self {
            of_colliders: of_pair.iter().map(index).collect(),
            pairs: keys.iter().map(pair).collect(),
            active: Vec::with_capacity(keys.len()),
            keys,
            of_body,
            sounds: vec![SoundState::default(); exhibit.sounds.len()],
        }
    }

    /// Sets all pairs apart and ends their damping; the synth fades by itself.
    pub fn reset(&mut self, sample: u64, out: &mut Vec<SoundCommand>) {
        for pair in self.active.drain(..) {
            let pair = &mut self.pairs[pair];
            (pair.state, pair.window, pair.active) = (ContactState::Apart, MergeWindow::default(), false);
        }
        for state in &mut self.sounds {
            let damp = state.damp.take();
            out.extend(damp.map(|damp| SoundCommand::Damp(Damp { sample, resistance: 0.0, ..damp })));
            state.slide = Slide::default();
        }
    }

    /// Adds an impact at this sample.
    pub fn add_impact(&mut self, impact: &Impact, sample: u64, scene: &SoundScene, out: &mut Vec<SoundCommand>) {
        let rests = impact.kind == ImpactKind::RestingContact;
        let inaudible = rests && (impact.speed < CONTACT.least_speed || impact.colliders.is_none());
        if impact.impulse < CONTACT.least_impulse || inaudible {
            return;
        }
        let key = impact.colliders.map_or_else(
            || sorted(impact.bodies.map(|body| body.unwrap_or(usize::MAX))),
            |colliders| key(scene.exhibit, colliders),
        );
        let Ok(index) = self.keys.binary_search(&key) else { return };
        self.activate(index);
        let pair = &mut self.pairs[index];
        let local =
            |body: Option<usize>| body.map_or(impact.point, |b| scene.bodies[b].pose().inverse_point(impact.point));
        let pulse = ImpactPulse {
            sample,
            impulse: impact.impulse,
            speed: impact.speed,
            mass: impact.mass,
            points: pair.bodies.map(local),
        };
        let due = pair.window.due(sample);
        let immediate = pair.window.push(pulse);
        for pulse in due.into_iter().chain(immediate) {
            strike(&pulse, pair.bodies, &self.of_body, scene, out);
        }
    }

    /// Advances all pairs to the end of a step, at `sample`, with its contacts.
    pub fn advance(
        &mut self,
        sample: u64,
        contacts: impl Iterator<Item = ContactReport>,
        scene: &SoundScene,
        out: &mut Vec<SoundCommand>,
    ) {
        self.active.iter().for_each(|&pair| self.pairs[pair].sum = PairSum::default());
        for contact in contacts {
            let pair = self.of_colliders[contact.pair];
            if pair != NONE {
                self.activate(pair as usize);
                self.pairs[pair as usize].sum.add(&contact);
            }
        }
        for state in &mut self.sounds {
            (state.sliding, state.damping) = (InstrumentSum::default(), InstrumentSum::default());
        }
        for &index in &self.active {
            let pair = &mut self.pairs[index];
            if let Some(pulse) = pair.window.due(sample) {
                strike(&pulse, pair.bodies, &self.of_body, scene, out);
            }
            pair.update_state();
            pair.active = pair.state != ContactState::Apart || pair.window.is_open(sample);
            if pair.state != ContactState::Apart {
                add_to_instruments(pair, &self.of_body, &mut self.sounds, scene);
            }
        }
        let pairs = &self.pairs;
        self.active.retain(|&pair| pairs[pair].active);
        for (sound, state) in scene.exhibit.sounds.iter().zip(&mut self.sounds) {
            let drawn = matches!(scene.exhibit.instruments[sound.instrument].surface, Some(SoundSurface::Relief(_)));
            state.send_slide(sample, sound.instrument as u16, drawn, scene.listener, out);
            state.send_damp(sample, sound.instrument as u16, out);
        }
    }

    fn activate(&mut self, pair: usize) {
        if !self.pairs[pair].active {
            self.pairs[pair].active = true;
            self.pairs[pair].sum = PairSum::default();
            self.active.push(pair);
        }
    }
}

impl SoundState {
    /// Sends an audible change of the sliding contact; on a surface that something is `drawn` on, each place is heard.
    fn send_slide(
        &mut self,
        sample: u64,
        instrument: u16,
        drawn: bool,
        listener: &AudioListener,
        out: &mut Vec<SoundCommand>,
    ) {
        let last = self.slide;
        if self.sliding.force == 0.0 {
            if last.force > 0.0 {
                self.slide = Slide { sample, force: 0.0, ..last };
                out.push(SoundCommand::Slide(self.slide));
            }
            return;
        }
        let place = listener.locate(self.sliding.point / self.sliding.force);
        let slide = Slide {
            sample,
            instrument,
            speed: (self.sliding.speed / self.sliding.force) as f32,
            force: self.sliding.force as f32,
            position: self.sliding.mean_position(),
            pan: place.pan,
            distance: place.distance,
        };
        let level = |a: f32, b: f32| differs(f64::from(a), f64::from(b), SLIDE_CHANGE.level);
        let position = |a: f32, b: f32| (a - b).abs() > SLIDE_CHANGE.position;
        if drawn
            || level(slide.speed, last.speed)
            || level(slide.force, last.force)
            || level(slide.distance, last.distance)
            || position(slide.pan, last.pan)
            || (0..2).any(|k| position(slide.position[k], last.position[k]))
        {
            self.slide = slide;
            out.push(SoundCommand::Slide(slide));
        }
    }

    /// Sends an audible change of the damping by contacts.
    fn send_damp(&mut self, sample: u64, instrument: u16, out: &mut Vec<SoundCommand>) {
        if self.damping.force == 0.0 {
            let damp = self.damp.take();
            out.extend(damp.map(|damp| SoundCommand::Damp(Damp { sample, resistance: 0.0, ..damp })));
            return;
        }
        let resistance = (CONTACT.resistance_per_force * self.damping.force) as f32;
        let damp = Damp { sample, instrument, position: self.damping.mean_position(), resistance };
        let changed = self.damp.is_none_or(|last| {
            let position = |k: usize| (damp.position[k] - last.position[k]).abs() > DAMP_CHANGE.position;
            (0..2).any(position) || differs(f64::from(resistance), f64::from(last.resistance), DAMP_CHANGE.level)
        });
        if changed {
            self.damp = Some(damp);
            out.push(SoundCommand::Damp(damp));
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

/// The ends of a pair of colliders: bodies, then fixed colliders.
fn key(exhibit: &Exhibit, colliders: [usize; 2]) -> [usize; 2] {
    sorted(colliders.map(|c| exhibit.colliders[c].body.unwrap_or(exhibit.bodies.len() + c)))
}

/// The ends of a limit: bodies, then the world.
fn limit_key(kind: &LimitKind) -> [usize; 2] {
    sorted(kind.bodies().map(|body| body.unwrap_or(usize::MAX)))
}

/// Sends a strike to each sound of the two bodies that impacts trigger.
fn strike(
    pulse: &ImpactPulse,
    bodies: [Option<usize>; 2],
    of_body: &[Vec<usize>],
    scene: &SoundScene,
    out: &mut Vec<SoundCommand>,
) {
    for (body, local) in bodies.into_iter().zip(pulse.points) {
        let Some(body) = body else { continue };
        let place = scene.listener.locate(scene.bodies[body].pose().point(local));
        for sound in of_body[body].iter().map(|&i| &scene.exhibit.sounds[i]).filter(|s| s.is_struck) {
            out.push(SoundCommand::Strike(Strike {
                sample: pulse.sample,
                instrument: sound.instrument as u16,
                impulse: pulse.impulse as f32,
                speed: pulse.speed as f32,
                mass: pulse.mass as f32,
                position: strike_position(scene.exhibit, sound, local),
                pan: place.pan,
                distance: place.distance,
            }));
        }
    }
}

/// Adds a pair in contact to the sums of its bodies' instruments. Every contact damps instruments that impacts strike. Of those
/// that sliding excites, only resting contacts do: their timbre includes the damping by the sliding body.
fn add_to_instruments(pair: &ContactPair, of_body: &[Vec<usize>], sounds: &mut [SoundState], scene: &SoundScene) {
    let PairSum { force, slip, roll, point } = pair.last;
    let point = point / force;
    for body in pair.bodies.into_iter().flatten() {
        let local = scene.bodies[body].pose().inverse_point(point);
        for &i in &of_body[body] {
            let sound = &scene.exhibit.sounds[i];
            let position = strike_position(scene.exhibit, sound, local);
            match (sound.on, pair.state) {
                (SoundTrigger::Slide, ContactState::Scrape) => {
                    sounds[i].sliding.add(InstrumentContact { force, speed: slip / force, point, position })
                }
                (SoundTrigger::Slide, ContactState::Roll) => {
                    let (rolling, speed) = (CONTACT.rolling_share * force, roll / force);
                    sounds[i].sliding.add(InstrumentContact { force: rolling, speed, point, position })
                }
                _ => sounds[i].damping.add(InstrumentContact { force, speed: 0.0, point, position }),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_have_hysteresis_and_scraping_goes_first() {
        let mut state = ContactState::Apart;
        for (slip, roll, expected) in [
            (0.015, 0.0, ContactState::Rest),
            (0.021, 0.0, ContactState::Scrape),
            (0.011, 1.0, ContactState::Scrape),
            (0.009, 0.03, ContactState::Rest),
            (0.009, 0.05, ContactState::Roll),
            (0.009, 0.03, ContactState::Roll),
            (0.03, 0.5, ContactState::Scrape),
            (0.0, 0.01, ContactState::Rest),
        ] {
            state = state.next(slip, roll);
            assert_eq!(state, expected, "slip {slip}, roll {roll} m/s");
        }
    }
}
