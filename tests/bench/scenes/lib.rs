//! Scenes of contacts and loops, each from stated sizes and a fixed seed: the same bits on every machine.
//!
//! | module | scenes |
//! |---|---|
//! | `stacks` | what should stand still: towers, boxes on a floor, a pyramid, a leaning wall |
//! | `falls` | what falls and comes to rest: piles, dominoes, balls through pegs, a chain, a bowl |
//! | `hung` | what hangs and hits: chimes, cradles, mobiles |
//! | `loops` | closed loops: four-bar ladders, a net |
//!
//! Bars are set by the scenes of [`measured`]; [`tuning`] has others of different size and shape, for work on the
//! engine.

mod builder;
mod falls;
mod hung;
mod loops;
mod stacks;

use soffio_offline::scene::{PhysicsScene, make};

/// Seed of what is random.
const SEED: u64 = 2;

/// The scenes that bars are measured on.
pub fn measured() -> Vec<PhysicsScene> {
    let mut scenes = Vec::new();
    scenes.extend([10, 16, 20].map(stacks::tower));
    scenes.push(falls::pile(50, SEED));
    scenes.extend([5, 10, 20, 40].map(falls::dominoes));
    scenes.push(falls::pegs(100, SEED));
    scenes.push(hung::chimes([20, 10], SEED));
    scenes.push(stacks::floor("side_by_side_100", [10, 10], 1e-3));
    for balls in 3..=7 {
        scenes.extend([0.0, 0.2e-3, 1e-3].map(|gap| hung::cradle(balls, gap)));
    }
    scenes.push(stacks::floor("contacts_1000", [25, 10], 20e-3));
    for loops in [5, 10, 20, 40, 80, 160] {
        scenes.extend([false, true].map(|limits| loops::ladder(loops, limits)));
    }
    scenes.push(loops::net(8));
    scenes.extend([15, 63, 255].map(|bodies| make::mobile(bodies, SEED)));
    scenes
}

/// Other scenes, to tune on.
pub fn tuning() -> Vec<PhysicsScene> {
    vec![
        stacks::leaning_wall(8, 5),
        stacks::pyramid(9),
        falls::heap(48, SEED + 1),
        falls::chain(40),
        falls::bowl(16, 12, SEED + 2),
    ]
}
