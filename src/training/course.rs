//! What is learnt from and what is marked: the sets, how large, from which worlds; the work shared among threads.
//!
//! Worlds below [`EXAM`] teach, the others examine. Recordings are parted by group: whatever a model is marked on, it
//! has met neither the recording nor one of its group, nor a scene in which one of them was mixed.

use std::fmt::Write as _;

use super::descent::{Example, Subject, examples, train, untaught};
use super::score::{Table, Verdict, judge};
use soffio_detector::BlowSettings;
use soffio_detector::features::decibels;
use soffio_detector::model::Network;
use soffio_math::noise::{Random, hash_words};
use soffio_soundscape::scenes::{Condition, Hearing, World};
use soffio_soundscape::{EXAM, Kind, Take, parallel::parallel};

/// Recordings are parted into so many parts by their groups.
pub const FOLDS: u64 = 5;
/// Every recording is learnt from at its own gain and at some more, within this, dB; so many copies in all.
const GAIN_DB: f64 = 12.0;
const COPIES: u64 = 5;
/// Recordings are few beside what is made: each of their frames counts for so many.
const RECORDED: f32 = 4.0;
/// Part of the made scenes that are heard with the gain turned up too far, and by how much at most, dB.
const RAILED: f64 = 0.08;
const RAILED_DB: f64 = 28.0;

/// How much is learnt.
#[derive(Clone, Copy, Debug)]
pub struct Course {
    /// What comes of an ear that had been taught is a mean of both, in which the old one has this share, 0 … 1.
    pub keep: f64,
    /// Lessons: each in new worlds, twice as many as in the last one, with the ear as the last one left it.
    pub lessons: u64,
    /// Worlds of speakers and rooms in the first lesson.
    pub worlds: u64,
    /// 1: an hour and a half of museum a world, and the rest in proportion.
    pub size: f64,
    /// Rounds over all examples after each lesson.
    pub rounds: usize,
    /// Changes everything that is drawn.
    pub seed: u64,
}

impl Course {
    /// Worlds met before a lesson.
    fn worlds_before(&self, lesson: u64) -> u64 {
        self.worlds * ((1 << lesson) - 1)
    }
}

/// Examples, and the network that they have taught.
#[derive(Clone, Debug)]
pub struct Learnt<const IN: usize, const FIRST: usize, const SECOND: usize> {
    /// All that was heard since the first lesson, which an ear that knew nothing heard.
    pub examples: Vec<Example<IN>>,
    /// What it began with.
    pub began: Network<IN, FIRST, SECOND>,
    /// What came of it.
    pub network: Network<IN, FIRST, SECOND>,
    /// Mean loss in the last round.
    pub loss: f64,
}

/// Scenes that a world teaches one capsule, or two, with: half of them at gains far from the usual.
fn scenes(size: f64, stereo: bool) -> Vec<(Condition, u64)> {
    let count = |full: f64| (full * size).round() as u64;
    let mut all = vec![
        // Two capsules take a sound of a museum for breath once in hours: so many there must be.
        (Condition::Museum, count(if stereo { 270.0 } else { 90.0 })),
        (Condition::Impulses, count(480.0)),
        (Condition::Alike, count(120.0)),
        (Condition::Isolated, count(180.0)),
        (Condition::Spoken, count(180.0)),
        (Condition::Companions, count(180.0)),
    ];
    all.extend([0.0, 5.0, 10.0, 15.0, 20.0].map(|snr| (Condition::Noisy(snr), count(45.0))));
    all.extend([5.0, 10.0, 15.0, 20.0].map(|snr| (Condition::Aside(snr), count(45.0))));
    all.extend([0, 1, 2].map(|room| (Condition::OwnVoice(room), count(24.0))));
    all.extend([0, 1, 2].map(|room| (Condition::Answered(room), count(30.0))));
    if stereo {
        // Of what goes past them, what differs is often all there is.
        all.extend([8.0, 14.0, 20.0, 26.0].map(|snr| (Condition::Between(snr), count(60.0))));
        // Puffs into the microphone that the kiosk's own sound hides all else of: two capsules hear them as wind.
        all.extend([0, 1, 2].map(|room| (Condition::TalkedOver(room), count(24.0))));
    }
    all.into_iter().flat_map(|(condition, n)| (0..n).map(move |i| (condition, i))).collect()
}

/// Examples of one world.
fn taught<const IN: usize, const FIRST: usize, const SECOND: usize>(
    subject: &Subject<IN, FIRST, SECOND>,
    world: &World,
    settings: &BlowSettings,
    course: &Course,
) -> Vec<Example<IN>> {
    let mut out = Vec::new();
    for (condition, index) in scenes(course.size, subject.stereo) {
        let mut random = Random::new(hash_words(&[course.seed, index, 3]));
        let railed = if random.unit() < RAILED { random.range(0.0, RAILED_DB) } else { 0.0 };
        let hearing = Hearing { gain_db: random.range(-GAIN_DB, GAIN_DB) + railed, stereo: subject.stereo };
        examples(&world.take(condition, index, hearing), settings, subject.inputs, &mut out);
    }
    out
}

fn world_seed(course: &Course, i: u64) -> u64 {
    hash_words(&[course.seed, i]) % EXAM
}

/// An ear with this network.
pub fn ear<const IN: usize, const FIRST: usize, const SECOND: usize>(
    subject: &Subject<IN, FIRST, SECOND>,
    network: &Network<IN, FIRST, SECOND>,
) -> BlowSettings {
    let mut settings = BlowSettings::default();
    (subject.give)(&mut settings, network.clone());
    settings
}

/// Learns from made worlds, lesson by lesson, with a network that has been taught or knows nothing; `tell` hears of each. What
/// an ear that knows nothing hears in its first lesson is forgotten after it.
pub fn learn<const IN: usize, const FIRST: usize, const SECOND: usize>(
    subject: &Subject<IN, FIRST, SECOND>,
    course: &Course,
    began: Network<IN, FIRST, SECOND>,
    mut tell: impl FnMut(u64, &Learnt<IN, FIRST, SECOND>),
) -> Learnt<IN, FIRST, SECOND> {
    let new = began == untaught();
    let mut learnt = Learnt { examples: Vec::new(), network: began.clone(), began, loss: 0.0 };
    for lesson in 0..course.lessons {
        if lesson == 1 && new {
            learnt.examples.clear();
        }
        let worlds = course.worlds_before(lesson)..course.worlds_before(lesson + 1);
        let ear = ear(subject, &learnt.network);
        let met = parallel(worlds.collect(), |i| taught(subject, &World::new(world_seed(course, i)), &ear, course));
        learnt.examples.extend(met.into_iter().flatten());
        (learnt.network, learnt.loss) = train(&learnt.network, &learnt.examples, course.rounds, course.seed + lesson);
        tell(lesson, &learnt);
    }
    learnt
}

/// Goes on with recordings, which are also mixed into a world of their own; the network and its loss.
pub fn refined<const IN: usize, const FIRST: usize, const SECOND: usize>(
    subject: &Subject<IN, FIRST, SECOND>,
    course: &Course,
    made: &Learnt<IN, FIRST, SECOND>,
    recordings: &[&Take],
    fold: u64,
) -> (Network<IN, FIRST, SECOND>, f64) {
    let mut all = made.examples.clone();
    let ear = ear(subject, &made.network);
    let world = World::new(world_seed(course, 1000 + fold)).with_recordings(recordings.iter().copied());
    all.extend(taught(subject, &world, &ear, course));
    for copy in 0..COPIES {
        let mut random = Random::new(hash_words(&[course.seed, copy, 4]));
        for take in recordings {
            let gain = random.range(-GAIN_DB, GAIN_DB);
            let from = all.len();
            examples(&take.with_gain(if copy == 0 { 0.0 } else { gain }), &ear, subject.inputs, &mut all);
            all[from..].iter_mut().for_each(|example| example.weight *= RECORDED);
        }
    }
    let (network, loss) = train(&made.network, &all, course.rounds, course.seed);
    (joined(course, &made.began, network), loss)
}

/// What came of a course: where it began with a network that had been taught, the mean of both.
pub fn joined<const IN: usize, const FIRST: usize, const SECOND: usize>(
    course: &Course,
    began: &Network<IN, FIRST, SECOND>,
    network: Network<IN, FIRST, SECOND>,
) -> Network<IN, FIRST, SECOND> {
    if *began == untaught() { network } else { mixed(began, &network, course.keep) }
}

/// Who goes on in new worlds forgets some of what the old ones taught. The mean of both ears knows both (Wortsman et al.,
/// "Model soups", 2022); the one before has this share of it, 0 … 1.
fn mixed<const IN: usize, const FIRST: usize, const SECOND: usize>(
    before: &Network<IN, FIRST, SECOND>,
    after: &Network<IN, FIRST, SECOND>,
    share: f64,
) -> Network<IN, FIRST, SECOND> {
    let mut mean = after.clone();
    mean.weights.to_mut().iter_mut().zip(&*before.weights).for_each(|(w, before)| *w += share * (before - *w));
    mean
}

/// The mean of ears that began alike; of none, none. Inputs are scaled as the first one scales them.
pub fn mean<const IN: usize, const FIRST: usize, const SECOND: usize>(
    networks: &[Network<IN, FIRST, SECOND>],
) -> Option<Network<IN, FIRST, SECOND>> {
    let (first, rest) = networks.split_first()?;
    let in_turn = (2..).zip(rest);
    Some(in_turn.fold(first.clone(), |mean, (count, next)| mixed(next, &mean, 1.0 / f64::from(count))))
}

/// The part that a group of recordings belongs to.
pub fn fold(group: &str) -> u64 {
    let letters: Vec<u64> = group.bytes().map(u64::from).collect();
    hash_words(&letters) % FOLDS
}

/// Marks of recordings, each by the model of its fold, which has not met its group.
pub fn cross_validated<const IN: usize, const FIRST: usize, const SECOND: usize>(
    subject: &Subject<IN, FIRST, SECOND>,
    course: &Course,
    made: &Learnt<IN, FIRST, SECOND>,
    recordings: &[Take],
) -> (Table, Vec<String>) {
    let (mut table, mut remarks) = (Table::default(), Vec::new());
    let networks = parallel((0..FOLDS).collect(), |k| {
        let known: Vec<&Take> = recordings.iter().filter(|t| fold(&t.group) != k).collect();
        refined(subject, course, made, &known, k).0
    });
    for (k, network) in (0..FOLDS).zip(networks) {
        let held: Vec<Take> = recordings.iter().filter(|t| fold(&t.group) == k).cloned().collect();
        marked(&ear(subject, &network), &held, &mut table, &mut remarks);
    }
    (table, remarks)
}

/// Marks recordings; what went wrong becomes a remark.
pub fn marked(settings: &BlowSettings, takes: &[Take], table: &mut Table, remarks: &mut Vec<String>) -> Vec<Verdict> {
    let verdicts = parallel((0..takes.len()).collect(), |i| judge(settings, &takes[i]));
    for (take, verdict) in takes.iter().zip(&verdicts) {
        if let Some(row) = Table::row(take) {
            table.add(row, take, verdict);
            remarks.extend(remark(take, verdict));
        }
    }
    verdicts
}

fn remark(take: &Take, verdict: &Verdict) -> Option<String> {
    let missed = take.kind == Kind::Blow && !verdict.detected();
    if verdict.ghosts.is_empty() && !missed {
        return None;
    }
    let mut remark = format!("{}:{}", take.name, if missed { " not heard" } else { "" });
    for ghost in &verdict.ghosts {
        let _ = write!(remark, " wind without breath at {ghost:.2} s");
        // A sound that is long over, or far below the others, did not do it.
        for event in take.events.iter().filter(|e| e.gain > 0.005 && e.at < *ghost && *ghost < e.until + 0.5) {
            let way = if event.on_table { " through the table" } else { "" };
            let db = 2.0 * decibels(event.gain);
            let _ = write!(remark, ", {}{way} {db:.0} dB since {:.2} s", event.what, event.at);
        }
    }
    Some(remark)
}

/// What an exam asks: row by row, so many scenes each.
pub fn exam(hours: f64) -> Vec<(String, Condition, u64)> {
    let takes = |seconds: f64| (3600.0 * hours / seconds).ceil() as u64;
    let mut rows = vec![
        ("museum".to_owned(), Condition::Museum, takes(60.0)),
        ("knocks, claps, pops, doors".to_owned(), Condition::Impulses, takes(20.0)),
        ("breath, 5-60 cm, 0-60°".to_owned(), Condition::Isolated, takes(5.0)),
    ];
    for distance in [0.1, 0.2, 0.4] {
        for angle in [0.0, 30.0, 60.0] {
            for child in [false, true] {
                let who = if child { "child" } else { "adult" };
                let row = format!("breath, {:.0} cm, {angle:2.0}°, {who}", 100.0 * distance);
                rows.push((row, Condition::Cell(distance, angle, child), takes(5.0 * 18.0)));
            }
        }
    }
    for snr in [0.0, 5.0, 10.0, 20.0] {
        rows.push((format!("breath in a museum, {snr:2.0} dB"), Condition::Noisy(snr), takes(5.0 * 4.0)));
    }
    for snr in [5.0, 10.0, 20.0] {
        rows.push((
            format!("breath past it in a museum, {snr:2.0} dB of hiss"),
            Condition::Aside(snr),
            takes(5.0 * 3.0),
        ));
    }
    for snr in [10.0, 15.0, 20.0] {
        rows.push((
            format!("breath past it in a museum, {snr:2.0} dB between two capsules"),
            Condition::Between(snr),
            takes(5.0 * 3.0),
        ));
    }
    rows.push(("breath after talk".to_owned(), Condition::Spoken, takes(5.0)));
    rows.push(("breath amid companions' talk".to_owned(), Condition::Companions, takes(5.0)));
    for room in 0..3 {
        rows.push((format!("the kiosk itself, room {}", room + 1), Condition::OwnVoice(room), takes(180.0)));
        rows.push((
            format!("the kiosk itself, talked over, room {}", room + 1),
            Condition::TalkedOver(room),
            takes(180.0),
        ));
        rows.push((format!("breath that it answers, room {}", room + 1), Condition::Answered(room), takes(60.0)));
    }
    rows
}

/// Marks of made scenes, `hours` of each kind whose name `asked` takes, from worlds that nobody has learnt from.
pub fn examined(
    settings: &BlowSettings,
    hours: f64,
    seed: u64,
    hearing: Hearing,
    asked: impl Fn(&str) -> bool,
) -> (Table, Vec<String>) {
    const WORLDS: u64 = 6;
    let worlds: Vec<World> = (0..WORLDS).map(|i| World::new(EXAM + hash_words(&[seed, i]) % EXAM)).collect();
    let rows = exam(hours).into_iter().filter(|(row, ..)| asked(row));
    let scenes = rows.flat_map(|(row, condition, n)| (0..n).map(move |i| (row.clone(), condition, i)));
    let results = parallel(scenes.collect(), |(row, condition, index)| {
        let mut random = Random::new(hash_words(&[seed, index, 5]));
        let hearing = Hearing { gain_db: hearing.gain_db + random.range(-3.0, 3.0), ..hearing };
        let mut take = worlds[(index % WORLDS) as usize].take(condition, index, hearing);
        let verdict = judge(settings, &take);
        // The sound itself is no longer needed; its length is.
        take.played = Vec::new();
        let remark = remark(&take, &verdict).map(|r| format!("{} {r}", take.group));
        let mut table = Table::default();
        table.add(&row, &take, &verdict);
        (table, remark)
    });
    let (mut table, mut remarks) = (Table::default(), Vec::new());
    for (one, remark) in results {
        table.join(one);
        remarks.extend(remark);
    }
    (table, remarks)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_present_ear_has_its_share_of_the_mean() {
        const ROUNDING: f64 = 1e-12;
        let present = &BlowSettings::default().model;
        let after = untaught();
        for share in [0.0, 0.25, 1.0] {
            let mean = mixed(present, &after, share);
            for ((w, before), after) in mean.weights.iter().zip(&*present.weights).zip(&*after.weights) {
                assert!((w - (share * before + (1.0 - share) * after)).abs() < ROUNDING, "{share}: {w}");
            }
        }
        let third = super::mean(&[after.clone(), (**present).clone(), after]).expect("a mean of three");
        let far = third.weights.iter().zip(&*present.weights).map(|(w, before)| (w - before / 3.0).abs());
        assert!(far.fold(0.0, f64::max) < ROUNDING, "one of three");
    }
}
