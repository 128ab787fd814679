//! A dragged chain by the source's rule: how much its links turn, and how far its end stays behind.

use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_multibody::procedural::{POSITION_TOLERANCE, PositionSolver, Settings};

use super::{Extras, Hand, chain, end_of};

const LINKS: usize = 8;

/// The source's own mechanisms: the uppermost link is taken and dragged away, by its rule. With more control the links turn less for the
/// same way of the hand, so that the chain keeps its form longer.
#[test]
fn by_the_sources_rule_a_chain_under_more_control_turns_less() {
    const PITCH: f64 = 0.044;
    let turned = |control: f64| {
        let world = chain(&[0.01; LINKS], PITCH, false);
        let settings = Settings { method: PositionSolver::Relaxation, retention: 0.5, control };
        let mut hand = Hand::with(&world, &Extras::default(), settings);
        let (mut rotation, mut behind) = (0.0_f64, 0.0_f64);
        for step in 1..=60 {
            // Half a metre to the side and a little up, in a quarter of a second.
            let t = f64::from(step) / 60.0;
            let displacement = t * t * (3.0 - 2.0 * t);
            let place = DVec3::new(0.5 * displacement, -PITCH + 0.1 * displacement, 0.0);
            hand.step(1.0 / 240.0, &[end_of(&world, 0, PITCH, place)]);
            let report = hand.procedural.report();
            assert!(report.residual <= POSITION_TOLERANCE, "step {step}: {report:?}");
            let links = hand.bodies()[1..].iter();
            let leans = |b: &RigidBody| {
                let angle = (b.rotation * DVec3::Y).angle_between(DVec3::Y);
                angle * angle
            };
            rotation += links.map(leans).sum::<f64>() / (LINKS - 1) as f64 / 60.0;
            let end = hand.bodies()[LINKS - 1].position;
            behind = behind.max(place.x - end.x);
        }
        (rotation.sqrt(), behind)
    };
    let (weak, strong) = (turned(1.0), turned(30.0));
    println!(
        "c = 1: links turned by {} rad rms, end {} m behind; c = 30: {} rad, {} m",
        weak.0, weak.1, strong.0, strong.1
    );
    assert!(weak.0 > 0.05, "{} rad: the hand turns the links", weak.0);
    assert!(strong.0 < 0.8 * weak.0, "{} and {} rad", strong.0, weak.0);
}
