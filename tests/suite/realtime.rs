//! The audio callback never allocates or frees, and what it plays lands on time.
//!
//! The allocator below only acts inside `assert_no_alloc(|| …)`, and only in debug builds.

use assert_no_alloc::{AllocDisabler, assert_no_alloc};
use soffio_sound::{InstrumentSpec, SoundBody, SoundCommand, SoundMaterial, Strike, Synth, WindSound};

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

fn synth(rate: u32) -> Synth {
    let body = SoundBody { half_extents: [0.05; 2], thickness: 8e-4, area: 0.0079, mass: 0.05 };
    let material = SoundMaterial { youngs_modulus: 2e11, poisson: 0.3, density: 7850.0, loss_factor: 6e-4 };
    let spec = |timbre: &str| InstrumentSpec {
        timbre: timbre.into(),
        own: None,
        body,
        material,
        surface: None,
        gain: 1.0,
        max_voices: 60,
    };
    Synth::new(rate, &[spec("plate"), spec("bell"), spec("wind-room")], 1).expect("shipped timbres compile")
}

fn strike(sample: u64, instrument: u16) -> SoundCommand {
    SoundCommand::Strike(Strike {
        sample,
        instrument,
        impulse: 1e-3,
        speed: 0.3,
        mass: 0.003,
        position: [0.7, 0.2],
        pan: 0.0,
        distance: 0.7,
    })
}

#[test]
fn the_synth_never_allocates() {
    let mut synth = synth(48_000);
    let mut out = vec![0.0f32; 2 * 480];
    let mut loudest = 0.0f32;
    assert_no_alloc(|| {
        // More hits than voices, more commands than room, bad numbers, wind, silence.
        for block in 0..200u64 {
            for i in 0..8u64 {
                synth.command(strike(block * 480 + i * 61, (i % 2) as u16));
            }
            synth.command(SoundCommand::Wind(WindSound {
                sample: block * 480,
                speed: 3.0,
                gust: 0.3,
                pan: 0.1,
                ..WindSound::default()
            }));
            if block % 50 == 49 {
                synth.command(SoundCommand::Silence { sample: block * 480 + 7 });
                (0..2000).for_each(|i| synth.command(strike(block * 480 + i, 0)));
                synth.command(SoundCommand::Wind(WindSound { speed: f32::NAN, ..WindSound::default() }));
            }
            synth.render(&mut out);
            loudest = out.iter().fold(loudest, |m, s| m.max(s.abs()));
        }
    });
    assert!(loudest > 0.1);
    assert!(synth.faults() == 4 && synth.lost() > 0);
}

#[cfg(feature = "kiosk")]
mod callback {
    use super::*;
    use soffio_devices::audio::output::{Engine, open};
    use soffio_devices::audio::{ClockMap, Knobs, LOUDEST, MicrophoneSamples, PlayedEnergy, Utterance, input};
    use std::sync::Arc;

    fn engine(rate: u32, generation: u64) -> Engine {
        Engine { synth: Box::new(synth(rate)), generation }
    }

    #[test]
    fn the_loudspeakers_callback_never_allocates_even_when_the_exhibit_changes() {
        let (mut player, mut voice, mut workshop) = open(48_000, 2, Arc::new(Knobs::new(0.5)));
        workshop.exchange(Some(engine(48_000, 0)));
        let mut block = vec![0.0f32; 2 * 480];
        let mut generation = 0;
        let mut loudest = 0.0f32;
        for step in 0..400u64 {
            voice.send(step * 480, &[strike(step * 480, (step % 2) as u16)], generation);
            if step % 37 == 36 {
                generation += 1;
                workshop.exchange(Some(engine(48_000, generation)));
            }
            assert_no_alloc(|| player.play(&mut block));
            loudest = block.iter().fold(loudest, |m, s| m.max(s.abs()));
        }
        assert!(loudest > 0.05 && loudest <= 1.0);
        // The reference is the mean of what went out.
        let mut heard = Vec::new();
        while let Ok(sample) = voice.reference().pop() {
            heard.push(sample);
        }
        assert_eq!(heard.len(), 48_000, "the ring keeps its first second when nobody listens");
    }

    #[test]
    fn every_layout_of_channels_and_every_block_is_played() {
        for channels in [1, 2, 6] {
            let (mut player, mut voice, mut workshop) = open(48_000, channels, Arc::new(Knobs::new(1.0)));
            workshop.exchange(Some(engine(48_000, 0)));
            let mut block = vec![0i16; channels * 777];
            assert_no_alloc(|| player.play(&mut block));
            voice.send(0, &[strike(0, 1)], 0);
            let mut loudest = vec![0; channels];
            for _ in 0..10 {
                assert_no_alloc(|| player.play(&mut block));
                for frame in block.chunks(channels) {
                    loudest.iter_mut().zip(frame).for_each(|(m, s): (&mut i16, _)| *m = (*m).max(s.saturating_abs()));
                }
            }
            assert!(loudest.iter().take(2).all(|m| *m > 300), "{channels} channels: {loudest:?}");
            assert!(loudest.iter().skip(2).all(|m| *m == 0), "{channels} channels: {loudest:?}");
        }
    }

    #[test]
    fn the_volume_glides_and_what_is_heard_is_measured() {
        // From half to exact silence within half a second, and no click: no allocation on the way.
        let knobs = Arc::new(Knobs::new(0.5));
        let (mut player, mut voice, mut workshop) = open(48_000, 2, knobs.clone());
        workshop.exchange(Some(engine(48_000, 0)));
        let mut block = vec![0.0f32; 2 * 480];
        voice.send(0, &[strike(0, 1)], 0);
        for i in 0..150 {
            match i {
                50 => knobs.set_volume(0.0),
                60 => knobs.set_night(true),
                _ => {}
            }
            assert_no_alloc(|| player.play(&mut block));
            if i > 50 + 60 {
                assert!(block.iter().all(|s| *s == 0.0), "block {i}");
            }
        }
        let PlayedEnergy { energy, seconds } = knobs.played();
        assert!((seconds - 1.5).abs() < 1e-9 && energy > 0.0, "{energy}, {seconds}");
    }

    #[test]
    fn words_are_said_over_a_softer_work_and_the_ear_gets_both() {
        /// The reference is their mean; both sides get the same words.
        const SAME: f32 = 1e-6;
        let (mut player, mut voice, mut workshop) = open(48_000, 2, Arc::new(Knobs::new(1.0)));
        workshop.exchange(Some(engine(48_000, 0)));
        let tone = |hz: f32, frames: usize| Utterance {
            samples: (0..frames).map(|i| LOUDEST * (std::f32::consts::TAU * hz * i as f32 / 48_000.0).sin()).collect(),
            sample_rate: 48_000,
        };
        let (first, second, none) = (tone(500.0, 96_000), tone(900.0, 24_000), tone(1.0, 0));
        let other_rate = Utterance { sample_rate: 44_100, ..second.clone() };
        // How much of a tone is in stereo frames, 0 to 1, from whole periods of both tones.
        let part = |stereo: &[f32], hz: f32| {
            let sum = stereo.chunks_exact(2).enumerate().fold((0.0_f64, 0.0_f64), |(c, s), (i, frame)| {
                let turn = std::f64::consts::TAU * f64::from(hz) * i as f64 / 48_000.0;
                (c + f64::from(frame[0]) * turn.cos(), s + f64::from(frame[0]) * turn.sin())
            });
            sum.0.hypot(sum.1) * 4.0 / stereo.len() as f64
        };
        let mut block = vec![0.0f32; 2 * 480];
        let mut spoken = Vec::new();
        for step in 0..250u64 {
            voice.send(step * 480, &[strike(step * 480, 0)], 0);
            match step {
                50 => voice.say(&first),
                100 => voice.say(&second),
                // More than there is room for: the newest that has room is said, and hushed all the same.
                160 => (0..40).for_each(|_| voice.say(&first)),
                180 => voice.say(&none),
                210 => voice.say(&other_rate),
                _ => {}
            }
            assert_no_alloc(|| player.play(&mut block));
            assert!(block.iter().all(|sample| sample.abs() <= 1.0), "step {step}");
            let reference: Vec<f32> = std::iter::from_fn(|| voice.reference().pop().ok()).collect();
            for (heard, frame) in reference.iter().zip(block.chunks_exact(2)) {
                assert!((heard - 0.5 * (frame[0] + frame[1])).abs() < SAME, "step {step}");
            }
            let speaks = voice.shared().speaks.load(std::sync::atomic::Ordering::Relaxed);
            spoken.push((speaks, part(&block, 500.0), part(&block, 900.0)));
        }
        let full = f64::from(LOUDEST);
        let loud = |part: f64| (part / full - 1.0).abs() < 0.1;
        assert!(!spoken[40].0 && spoken[40].1 < 0.1 * full, "{:?}", spoken[40]);
        assert!(spoken[70].0 && loud(spoken[70].1) && spoken[70].2 < 0.1 * full, "the first: {:?}", spoken[70]);
        // Half a second is 50 steps; the first took 0.1 s or so to fade.
        assert!(spoken[125].0 && loud(spoken[125].2) && spoken[125].1 < 0.1 * full, "the second: {:?}", spoken[125]);
        assert!(spoken[..100].iter().skip(60).all(|(speaks, ..)| *speaks));
        for (step, words) in spoken.iter().enumerate().skip(225) {
            assert!(!words.0 && words.1 < 0.1 * full && words.2 < 0.1 * full, "hushed, step {step}: {words:?}");
        }
    }

    #[test]
    fn commands_for_other_instruments_are_not_played() {
        let (mut player, mut voice, mut workshop) = open(48_000, 2, Arc::new(Knobs::new(1.0)));
        workshop.exchange(Some(engine(48_000, 3)));
        let mut block = vec![0.0f32; 960];
        player.play(&mut block);
        voice.send(0, &[strike(0, 0)], 2);
        for _ in 0..10 {
            player.play(&mut block);
            assert!(block.iter().all(|s| *s == 0.0));
        }
    }

    #[test]
    fn the_microphones_callback_never_allocates_and_picks_its_channel() {
        let samples: Vec<i16> = (0..2000).map(|i| if i % 2 == 0 { 8192 } else { -16384 }).collect();
        // Full scale is 32768, so these are exact.
        for (channels, first, second) in [
            ([1, 0], 0.25, None),
            ([2, 0], -0.5, None),
            ([0, 0], 0.25, Some(-0.5)),
            ([9, 0], -0.125, None),
            ([1, 2], 0.25, Some(-0.5)),
            ([2, 1], -0.5, Some(0.25)),
            // No second capsule: it is the first one, the device lacks it, or the first is a mix.
            ([1, 1], 0.25, None),
            ([1, 3], 0.25, None),
            ([0, 2], -0.125, None),
        ] {
            let (mut recorder, mut capture) = input::open(48_000, 2, channels);
            assert_no_alloc(|| recorder.record(&samples));
            let mut heard = MicrophoneSamples::default();
            assert_eq!(capture.read(&mut heard), 1000);
            assert_eq!(capture.capsules(), 1 + usize::from(second.is_some()), "channels {channels:?}");
            assert_eq!(*heard.samples, [first; 1000], "channels {channels:?}");
            assert_eq!(*heard.second, second.map_or(vec![], |sample| vec![sample; 1000]), "channels {channels:?}");
        }
    }

    #[test]
    fn from_microphone_to_wind_the_delay_does_not_grow_in_an_hour() {
        use std::time::Duration;

        // A crystal 300 millionths fast, blocks of 10 ms, a kiosk that wakes when it likes and once stands still for 1 s.
        const RATE: f64 = 48_000.0 * 1.0003;
        const BLOCK: u64 = 480;
        // A block waits for its end; nothing else may wait.
        const LONGEST_S: f64 = BLOCK as f64 / RATE + 1e-6;
        let (mut recorder, mut capture) = input::open(48_000, 1, [1, 0]);
        let mut pacer = soffio_kiosk::live::step_scheduler::StepScheduler::default();
        let mut random = soffio_math::noise::Random::new(5);
        let (mut now, mut sent, mut heard_in_all) = (0.0, 0_u64, 0_u64);
        let mut heard = MicrophoneSamples::default();
        while now < 3600.0 {
            let nap = if (now..now + 0.02).contains(&1800.0) { 1.0 } else { random.range(1e-4, 0.012) };
            now += nap;
            while (sent + BLOCK) as f64 / RATE <= now {
                // 24 bits of the sample's own number: what a float holds exactly.
                let block: Vec<f32> = (sent..sent + BLOCK).map(|i| (i % (1 << 24)) as f32 / (1 << 24) as f32).collect();
                recorder.record(&block);
                sent += BLOCK;
            }
            if pacer.due(Duration::from_secs_f64(now)) == 0 {
                continue;
            }
            heard.clear();
            heard_in_all += capture.read(&mut heard) as u64;
            assert_eq!(heard_in_all, sent, "at {now} s samples wait or are lost");
            if let Some(&last) = heard.samples.last() {
                assert_eq!((f64::from(last) * f64::from(1 << 24)) as u64, (sent - 1) % (1 << 24), "at {now} s");
                let age = now - sent as f64 / RATE;
                assert!(age < LONGEST_S + nap, "at {now} s the newest sample is {age} s old");
            }
        }
        assert!(pacer.dropped() > 200, "the standstill was one");
    }

    #[test]
    fn hits_keep_their_distance_while_the_clocks_drift() {
        // A loudspeaker 200 ppm fast with blocks of 480 against steps of 200 samples; hits every 0.1 s.
        // Jitter allowed: the block's sawtooth through a filter of 480 looks, plus rounding.
        const JITTER: f64 = 3.0;
        let mut clock = ClockMap::new(48_000);
        let (mut late, mut last) = (0, None);
        for step in 1..48_000u64 {
            let now = step * 200;
            let position = (now as f64 * 1.0002) as u64 / 480 * 480;
            clock.look(now, position, 480);
            if step % 24 == 0 {
                let frame = clock.frame(now - 100);
                late += u64::from(frame < position);
                if let Some(last) = last.replace(frame) {
                    let apart = (frame - last) as f64;
                    assert!((apart - 4800.0 * 1.0002).abs() < JITTER, "step {step}: {apart}");
                }
            }
        }
        assert_eq!(late, 0);
        // After a standstill of a second the map starts again.
        clock.look(10_000_000, 10_050_000, 480);
        assert_eq!(clock.frame(10_000_000), 10_050_680);
    }
}

/// Against a real sound server. Not part of the usual run: it needs a PulseAudio whose sink `speakers` is looped back as
/// `speakers.monitor`, and it takes real seconds.
#[cfg(feature = "kiosk")]
mod server {
    use std::time::{Duration, Instant};

    use super::*;
    use soffio_devices::audio::{AudioIo, AudioSettings, DeviceState, MicrophoneSamples};

    fn settings() -> AudioSettings {
        AudioSettings {
            microphone: "speakers.monitor".into(),
            output: "speakers".into(),
            volume_db: 0.0,
            ..AudioSettings::default()
        }
    }

    #[test]
    #[ignore = "needs a PulseAudio with a null sink `speakers`"]
    fn what_is_sent_is_heard_on_time_and_at_its_level() {
        // The loop is digital: levels agree to the rounding of f32, distances to the clock map's slow glide.
        const LEVEL: f32 = 1e-3;
        const JITTER: u64 = 16;
        const APART: u64 = 24_000;
        let mut io = AudioIo::start(&settings(), synth);
        let mut heard = MicrophoneSamples::default();
        let began = Instant::now();
        let mut step = 0u64;
        while step < 240 * 8 {
            std::thread::sleep(Duration::from_millis(2));
            while began.elapsed().as_secs_f64() * 240.0 > step as f64 {
                let now = step * 200;
                let due = now.is_multiple_of(APART) && now > APART;
                io.send(now + 200, &[strike(now + 100, 0)][..usize::from(due)]);
                step += 1;
            }
            if io.read_microphone(&mut heard).is_none() {
                assert!(began.elapsed() < Duration::from_secs(5), "no microphone: {:?}", io.status());
            }
        }
        let status = io.status();
        let MicrophoneSamples { samples: heard, reference, .. } = heard;
        println!("{status:?}, heard {} samples", heard.len());
        assert!(matches!(status.output, DeviceState::Ok { .. }) && matches!(status.input, DeviceState::Ok { .. }));
        assert_eq!(heard.len(), reference.len());
        assert!(heard.len() > 7 * 48_000, "the machine was too busy to judge: samples are missing");
        let onsets = |samples: &[f32]| {
            let mut found: Vec<u64> = Vec::new();
            for (i, s) in samples.iter().enumerate() {
                let loud = s.abs() > 0.08;
                if loud && found.last().is_none_or(|last| i as u64 > last + APART / 2) {
                    found.push(i as u64);
                }
            }
            found
        };
        let (in_air, sent) = (onsets(&heard), onsets(&reference));
        println!("onsets {in_air:?}\nplayed {sent:?}");
        assert!(in_air.len() >= 10);
        let peak = |samples: &[f32]| samples.iter().fold(0.0f32, |m, s| m.max(s.abs()));
        println!("peaks: heard {}, played {}", peak(&heard), peak(&reference));
        assert!((peak(&heard) - peak(&reference)).abs() < LEVEL);
        // A shared machine hiccups now and then, and the device's clock with it: two distances of three must be right.
        let exact = in_air.windows(2).filter(|pair| (pair[1] - pair[0]).abs_diff(APART) <= JITTER).count();
        assert!(3 * exact >= 2 * (in_air.len() - 1), "{in_air:?}");
        // What was played is known before it is heard, by the latency of both devices.
        let lead = in_air.iter().zip(&sent).filter(|(air, sent)| sent <= air).count();
        println!("{exact} of {} distances exact, {lead} of {} known before", in_air.len() - 1, in_air.len());
    }

    #[test]
    #[ignore = "needs a PulseAudio with a null sink `speakers`"]
    fn the_microphone_is_closed_and_opened_again_and_instruments_arrive() {
        const LONG: Duration = Duration::from_secs(10);
        let until = |io: &mut AudioIo, what: &str, done: &dyn Fn(&mut AudioIo) -> bool| {
            let began = Instant::now();
            while !done(io) {
                assert!(began.elapsed() < LONG, "{what}: {:?}", io.status());
                std::thread::sleep(Duration::from_millis(5));
            }
        };
        let hears = |io: &mut AudioIo| io.read_microphone(&mut MicrophoneSamples::default()).is_some();
        let mut io = AudioIo::start_with(&settings(), false, synth);
        until(&mut io, "it begins closed", &|io| io.status().input == DeviceState::Closed);
        assert!(!hears(&mut io));
        io.listen(true);
        until(&mut io, "it opens", &hears);
        io.listen(false);
        until(&mut io, "it closes", &|io| !hears(io) && io.status().input == DeviceState::Closed);
        until(&mut io, "the first instruments", &|io| {
            io.send(0, &[]);
            io.has_instruments()
        });
        io.set_instruments(synth);
        assert!(!io.has_instruments(), "they are being built");
        until(&mut io, "the next instruments", &|io| io.has_instruments());
    }

    #[test]
    #[ignore = "needs a PulseAudio that is ended and started again while it runs"]
    fn a_lost_server_is_found_again() {
        let mut io = AudioIo::start(&settings(), synth);
        let mut heard = MicrophoneSamples::default();
        let (mut ok, mut lost, mut again) = (false, false, false);
        let began = Instant::now();
        while !again && began.elapsed() < Duration::from_secs(40) {
            std::thread::sleep(Duration::from_millis(50));
            io.read_microphone(&mut heard);
            let status = io.status();
            let both = |f: fn(&DeviceState) -> bool| f(&status.input) && f(&status.output);
            let works = both(|s| matches!(s, DeviceState::Ok { .. }));
            let missing = both(|s| matches!(s, DeviceState::Missing(_)));
            let before = (ok, lost, again);
            ok |= works;
            lost |= ok && missing;
            again |= lost && works;
            if before != (ok, lost, again) {
                println!("{:.1} s: {} / {}", began.elapsed().as_secs_f64(), status.input, status.output);
            }
        }
        assert!(ok && lost && again, "{:?}", io.status());
    }
}
