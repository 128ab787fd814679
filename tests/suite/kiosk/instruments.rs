//! Instruments that staff try, as the loudspeaker plays them.

use std::path::Path;

use soffio_exhibit as exhibit;
use soffio_kiosk::step::instruments::{
    Audition, AuditionInstrument, AuditionTarget, SynthSetup, hit, shipped, timbres,
};
use soffio_sound::timbre;
use soffio_sound::{SoundCommand, Synth};

const RATE: u32 = 48_000;
/// Energy of a second, full scale 1, below which nothing is heard: a tenth of a per mille of full scale throughout.
const SILENCE: f64 = 1e-8 * RATE as f64;
/// A sound that is panned to one side is so much stronger there, in energy: 20 dB.
const ASIDE: f64 = 100.0;
/// Twice as fast a hit has four times the energy by its impulse alone; half of that is asked, for the limiter.
const HARDER: f64 = 2.0;

/// Energies of the left and the right in the second after these commands.
fn play(mut synth: Synth, commands: &[SoundCommand]) -> [f64; 2] {
    commands.iter().for_each(|command| synth.command(*command));
    let mut stereo = vec![0.0; 2 * RATE as usize];
    synth.render(&mut stereo);
    let energy = |side: usize| stereo.iter().skip(side).step_by(2).map(|&x| f64::from(x) * f64::from(x)).sum();
    [energy(0), energy(1)]
}

#[test]
fn every_timbre_on_offer_sounds_after_the_works_own_and_on_the_side_that_is_asked() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/steel-fish");
    let fish = exhibit::load(&folder).expect("the shipped exhibit is valid");
    let voice = SynthSetup { reverb: None, most_partials: 4096, seed: 1 };
    let own = fish.instruments.len() as u16;
    let mut offered = 0;
    for preset in timbres() {
        let name = &preset.name;
        let guest = AuditionInstrument { preset: preset.clone() };
        let sounded = |speed: f64, pan: f32| {
            let audition = Audition { target: AuditionTarget::Timbre(preset.clone()), speed, pan };
            play(voice.synth(&fish, Some(&guest))(RATE), &guest.play(own, &audition, 0))
        };
        let [left, right] = sounded(0.5, -1.0);
        assert!(left > SILENCE && left > ASIDE * right, "{name}: {left} left, {right} right");
        let [left, right] = sounded(0.5, 1.0);
        assert!(right > SILENCE && right > ASIDE * left, "{name}: {left} left, {right} right");
        offered += 1;
    }
    assert_eq!(offered, timbre::names().count());
    // Without the guest the same command reaches nothing.
    let bell = AuditionInstrument { preset: shipped("bell").expect("a shipped timbre") };
    let audition = Audition { target: AuditionTarget::Timbre(bell.preset.clone()), speed: 0.5, pan: 0.0 };
    let [left, right] = play(voice.synth(&fish, None)(RATE), &bell.play(own, &audition, 0));
    assert_eq!(left + right, 0.0);
}

#[test]
fn a_harder_hit_on_the_works_own_instrument_is_louder() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/steel-fish");
    let fish = exhibit::load(&folder).expect("the shipped exhibit is valid");
    let voice = SynthSetup { reverb: None, most_partials: 4096, seed: 1 };
    let energy = |speed: f64| {
        let audition = Audition { target: AuditionTarget::Exhibit(0), speed, pan: 0.0 };
        play(voice.synth(&fish, None)(RATE), &[hit(0, &audition, 0)]).iter().sum::<f64>()
    };
    let (soft, hard) = (energy(0.02), energy(0.04));
    assert!(soft > SILENCE && hard > HARDER * soft, "{soft} and {hard}");
}
