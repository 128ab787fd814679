//! Balanced mobiles: branches, hanging pieces, and the statics of the whole.
//!
//! A piece is in equilibrium when the torque of its own weight and of the loads at its joints about its hook is zero: Σ
//! mᵢ xᵢ = Σ mᵢ zᵢ = 0 in its own frame. For a straight branch of length l with loads m_L, m_R and wire mass w the loop
//! is at a = (m_R l + w l/2)/(m_L + m_R + w) from the left. [`branch`] starts near there and corrects it by the true
//! centre of the bent wire. A branch is stable because its loop is above the line of its loads.
//!
//! Invariant: every piece of a [`Mobile`] except the first hangs at a marker of an earlier one, at the position of its
//! pose.

use soffio_geometry::bodies::MassProperties;
use soffio_math::{DQuat, DVec2, DVec3, PI, Pose};

use super::outline::ring;
use super::piece::{BentWire, Part, Piece, load, yaw};

/// Segments of an eye bent in wire.
pub const EYE_STEPS: usize = 12;
/// Density of steel, kg/m³.
pub const STEEL: f64 = 7850.0;
/// Standard gravity, m/s²; the period depends on it, the balance does not.
const GRAVITY: f64 = 9.81;

/// A balanced mobile: all pieces in their equilibrium poses.
#[derive(Debug)]
pub struct Mobile {
    /// Pieces with the poses of their frames; a piece comes before its loads.
    pub pieces: Vec<(Piece, Pose)>,
    /// The fixed piece.
    pub stand: Piece,
}

/// A branch of the mobile.
pub struct Branch {
    /// Names of the piece, its loop, its wire, and the markers of its right (+x) and left (−x) ends.
    pub names: [&'static str; 5],
    /// Radius of the wire, m.
    pub radius: f64,
    /// Radius of the loop and the eyes, m.
    pub eye: f64,
    /// Distance between the two loads, m.
    pub chord: f64,
    /// Droop of the right and the left end, m.
    pub droop: [f64; 2],
    /// Segments of each arm.
    pub steps: usize,
    /// Masses at the right and the left end, kg.
    pub loads: [f64; 2],
    /// Parts fixed to the right and to the left end, relative to it.
    pub tips: [Option<Part>; 2],
}

impl Branch {
    /// Mass properties of a piece bent from this branch, with its loads.
    fn loaded(&self, piece: &Piece) -> MassProperties {
        let [.., right, left] = self.names;
        let loads = [load(self.loads[0], piece.marker(right)), load(self.loads[1], piece.marker(left))];
        loads.iter().fold(piece.mass(), |whole, load| whole.combine(load))
    }

    /// Total masses at the right and the left end, kg.
    fn ends(&self) -> [f64; 2] {
        let tip = |k: usize| self.tips[k].as_ref().map_or(0.0, |tip| tip.solid.mass(tip.density).mass);
        [self.loads[0] + tip(0), self.loads[1] + tip(1)]
    }
}

/// Bends a wire whose right end droops so far that the centre of all loads is `depth` m below the loop, which
/// determines the period of its tilt. The left end droops, or rises, as drawn.
pub fn branch_of_depth(mut drawn: Branch, depth: f64) -> Piece {
    // Newton iteration: the droop moves the centre by the right end's fraction of the whole mass.
    let [right, left] = drawn.ends();
    let share = right / (right + left);
    for _ in 0..20 {
        let missing = depth + drawn.loaded(&branch(&drawn)).center.y;
        drawn.droop[0] += missing / share;
    }
    branch(&drawn)
}

/// Bends a wire with a loop at its balance point, and an eye at each end.
pub fn branch(branch: &Branch) -> Piece {
    let [name, hook, wire, right_mark, left_mark] = branch.names;
    let bend = |right: f64| {
        let left = branch.chord - right;
        let bottom = branch.radius - 2.0 * branch.eye;
        // The ends leave the loop level and droop as x², the shape of a light wire.
        let [right_droop, left_droop] = branch.droop;
        let arm = |length: f64, side: f64, droop: f64| {
            (1..=branch.steps).map(move |i| {
                let t = i as f64 / branch.steps as f64;
                DVec3::new(side * length * t, bottom - droop * t * t, 0.0)
            })
        };
        let eye_at = |end: DVec3| end - branch.eye * DVec3::Y;
        let right_eye = eye_at(DVec3::new(right, bottom - right_droop, 0.0));
        let left_eye = eye_at(DVec3::new(-left, bottom - left_droop, 0.0));

        let mut points = ring(left_eye, branch.eye, DVec3::Y, DVec3::Z, EYE_STEPS);
        points.reverse();
        points.extend(arm(left, -1.0, left_droop).collect::<Vec<_>>().into_iter().rev().skip(1));
        points.extend(ring(
            DVec3::new(0.0, branch.radius - branch.eye, 0.0),
            branch.eye,
            DVec3::NEG_Y,
            DVec3::X,
            EYE_STEPS,
        ));
        points.extend(arm(right, 1.0, right_droop).take(branch.steps - 1));
        points.extend(ring(right_eye, branch.eye, DVec3::Y, DVec3::Z, EYE_STEPS));
        let rest = (branch.eye - branch.radius) * DVec3::Y;
        let fixed = branch.tips.iter().zip([right_eye, left_eye]).filter_map(|(tip, end)| {
            let mut part = tip.clone()?;
            part.place.position += end;
            Some(part)
        });
        Piece {
            name,
            parts: fixed.collect(),
            wires: vec![BentWire { name: wire, points, radius: branch.radius, density: STEEL }],
            markers: vec![(hook, DVec3::ZERO), (right_mark, right_eye - rest), (left_mark, left_eye - rest)],
        }
    };
    // Newton iteration, a contraction: moving the loop by δ moves everything except the loop's own wire by −δ.
    let [right_end, left_end] = branch.ends();
    let start = left_end / (left_end + right_end) * branch.chord;
    let right = (0..40).fold(start, |right, _| right - branch.loaded(&bend(right)).center.x);
    bend(right)
}

/// Dimensions of the two branches of a [`cascade`], the upper one first.
pub struct CascadeBranches {
    /// Radius of the wire, m.
    pub radius: [f64; 2],
    /// Radius of the loop and the eyes, m.
    pub eye: [f64; 2],
    /// Distance between the two loads, m.
    pub chord: [f64; 2],
    /// Droop of the ends, m.
    pub droop: [f64; 2],
    /// Rotation of the lower branch relative to the upper one, rad.
    pub lower_yaw: f64,
}

/// Three pieces on two branches: the large one on the left of the upper branch; on its right a lower branch with the
/// middle and the small one.
pub fn cascade(hook: DVec3, wires: &CascadeBranches, [large, middle, small]: [Piece; 3], stand: Piece) -> Mobile {
    let bent = |i: usize, names, loads| {
        let CascadeBranches { radius, eye, chord, droop, .. } = wires;
        branch(&Branch {
            names,
            radius: radius[i],
            eye: eye[i],
            chord: chord[i],
            droop: [droop[i]; 2],
            steps: 6,
            loads,
            tips: [None, None],
        })
    };
    let loads = [small.mass().mass, middle.mass().mass];
    let lower = bent(1, ["Lower", "LowerLoop", "LowerWire", "LowerRight", "LowerLeft"], loads);
    let below = lower.mass().mass + small.mass().mass + middle.mass().mass;
    let loads = [below, large.mass().mass];
    let upper = bent(0, ["Upper", "UpperLoop", "UpperWire", "UpperRight", "UpperLeft"], loads);
    let top = Pose { rotation: DQuat::IDENTITY, position: hook };
    let hanging =
        |pose: Pose, piece: &Piece, marker| Pose { rotation: yaw(0.0), position: pose.point(piece.marker(marker)) };
    let large_pose = hanging(top, &upper, "UpperLeft");
    let lower_pose = Pose { rotation: yaw(wires.lower_yaw), ..hanging(top, &upper, "UpperRight") };
    let small_pose = hanging(lower_pose, &lower, "LowerRight");
    let middle_pose = hanging(lower_pose, &lower, "LowerLeft");
    let pieces =
        vec![(upper, top), (lower, lower_pose), (large, large_pose), (middle, middle_pose), (small, small_pose)];
    Mobile { pieces, stand }
}

/// Statics of a balanced mobile.
#[derive(Clone, Copy, Debug)]
pub struct Statics {
    /// Total mass, kg.
    pub total_mass: f64,
    /// Largest horizontal distance of a piece's loaded centre of mass from its hook, m.
    pub worst_offset: f64,
    /// Moment of inertia about the vertical through the hook, kg m². Each hanging piece counts as a point mass at its hook.
    pub yaw_inertia: f64,
    /// Depth of the centre of mass below the hook, m; hanging pieces count likewise.
    pub depth: f64,
    /// Period of small oscillations about the hook, in the plane of the arm, s.
    pub tilt_period: f64,
}

impl Mobile {
    /// Mass properties of piece `i` with its loads at its markers, in its own frame.
    pub fn loaded(&self, i: usize) -> MassProperties {
        let (piece, pose) = &self.pieces[i];
        self.pieces
            .iter()
            .enumerate()
            .filter(|(k, (_, hanging))| {
                *k != i && piece.markers.iter().skip(1).any(|(_, m)| pose.point(*m) == hanging.position)
            })
            .map(|(k, (_, hanging))| load(self.loaded(k).mass, pose.inverse_point(hanging.position)))
            .fold(piece.mass(), |whole, load| whole.combine(&load))
    }

    /// Computes the statics of the mobile.
    pub fn statics(&self) -> Statics {
        let top = self.loaded(0);
        let about_point = top.inertia_about(DVec3::ZERO);
        let offset = |i: usize| {
            let center = self.loaded(i).center;
            DVec2::new(center.x, center.z).length()
        };
        let depth = -top.center.y;
        Statics {
            total_mass: top.mass,
            worst_offset: (0..self.pieces.len()).map(offset).fold(0.0, f64::max),
            yaw_inertia: about_point.y_axis.y,
            depth,
            tilt_period: 2.0 * PI * (about_point.z_axis.z / (top.mass * GRAVITY * depth)).sqrt(),
        }
    }
}
