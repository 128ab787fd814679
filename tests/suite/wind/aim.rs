//! Aim and its visible signs: the ring, the meter, and dust that the wind carries.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::DVec3;
use soffio_simulation::{Command, Profile, Settings, Simulation, StepInput};
use soffio_wind::ambient::{Modulation, Wind, WindKind};
use soffio_wind::breath::{SPREAD, TAN_HALF_ANGLE};

const ROUNDING: f64 = 1e-12;

fn pendulum() -> Exhibit {
    let folder = exhibit::resolve("pendulum").unwrap_or_else(|report| panic!("{report}"));
    exhibit::load(&folder).unwrap_or_else(|report| panic!("{report}"))
}

#[test]
fn the_ring_is_as_wide_as_the_breath_and_the_meter_as_full_as_it_is_strong() {
    for law in ["jet", "cone"] {
        let mut exhibit = pendulum();
        exhibit.breath.law = if law == "jet" {
            Default::default()
        } else {
            soffio_wind::breath::SpreadLaw::Cone { vertex_distance: None }
        };
        let settings = Settings { profile: Profile::Physical, ..Settings::default() };
        let mut simulation = Simulation::new(Arc::new(exhibit), settings);
        let shown = |simulation: &mut Simulation, speed: f64| {
            let commands = [Command::Blow(Some(speed))];
            simulation.step(&StepInput { commands: &commands, pointer: Some([0.4, 0.3]), ..StepInput::default() });
            simulation.snapshot().breath
        };
        let breath = shown(&mut simulation, 0.0);
        assert_eq!(breath.meter, 0.0, "nobody blows");
        // In the true profile the breath meets the plane through the target half a metre on.
        let x = breath.mouth.distance(breath.ring.center);
        assert!((x - settings.distance).abs() < ROUNDING, "{x} m");
        let expected = match law {
            "jet" => SPREAD * x,
            _ => 0.5 * settings.lip_diameter + TAN_HALF_ANGLE * x,
        };
        assert!((breath.ring.radius - expected).abs() < ROUNDING, "{law}: {} m", breath.ring.radius);
        assert!((breath.ring.axis - (breath.ring.center - breath.mouth).normalize()).length() < ROUNDING);
        let at = simulation.view(16.0 / 9.0).project(breath.ring.center, 16.0 / 9.0).expect("before the eye");
        assert!((at[0] - 0.4).abs() < ROUNDING && (at[1] - 0.3).abs() < ROUNDING, "the ring is at {at:?}");
        assert_eq!(shown(&mut simulation, 8.0).meter, 0.5);
        assert_eq!(shown(&mut simulation, 40.0).meter, 1.0);
    }
}

/// The gallery's force goes with the speed up to 36 m/s, not with its square; no breath counts more than one of 1 m/s would.
const GALLERY_MOST: f64 = 36.0;

#[test]
fn the_gallery_never_weakens_a_breath_and_the_true_profile_never_changes_it() {
    // A child's breath half as hard as a grown-up's pushes with more than half of its force: its root.
    let force = |speed: f64| speed * speed * Profile::Gallery.gain(speed);
    assert!(
        (force(3.25) / force(6.5) - 0.5_f64.sqrt()).abs() < ROUNDING
            && (force(17.0) / force(8.5) - 2.0).abs() < ROUNDING
    );
    for speed in [0.1, 1.0, 1.9, 3.8, 8.9, 17.0, 30.0, 60.0] {
        assert_eq!(Profile::Physical.gain(speed), 1.0);
        assert!((1.0..=GALLERY_MOST).contains(&Profile::Gallery.gain(speed)));
        // A harder blow is more wind, not less.
        assert!(force(1.01 * speed) > force(speed), "at {speed} m/s");
    }
}

#[test]
fn dust_goes_with_every_wind_and_none_is_lost() {
    let direction = DVec3::new(1.0, 0.0, 1.0).normalize();
    let mut exhibit = pendulum();
    let kind = WindKind::Draught { direction, inlet: None };
    exhibit.winds = vec![Wind { name: "draught".into(), kind, speed: 0.3.into(), modulation: Modulation::Steady }];
    let mut simulation = Simulation::new(Arc::new(exhibit), Settings::default());
    let count = simulation.snapshot().dust_particles.len();
    for step in 0..1200 {
        let commands = [Command::Blow(Some(if step / 240 % 2 == 1 { 9.0 } else { 0.0 }))];
        simulation.step(&StepInput { commands: &commands, ..StepInput::default() });
        assert_eq!(simulation.snapshot().dust_particles.len(), count);
    }
    for _ in 0..240 {
        simulation.step(&StepInput { commands: &[Command::Blow(Some(0.0))], ..StepInput::default() });
    }
    let motes = simulation.snapshot().dust_particles;
    let mean = motes.iter().map(|m| DVec3::from(m.velocity.map(f64::from))).sum::<DVec3>() / count as f64;
    // Some have just come back, at rest, and all have a slow drift of their own.
    assert!(mean.dot(direction) > 0.25 && mean.dot(direction) < 0.35, "{mean}");
    assert!((mean - mean.dot(direction) * direction).length() < 0.02, "{mean}");
    assert!(motes.iter().all(|m| m.position.iter().all(|x| x.is_finite())));
}
