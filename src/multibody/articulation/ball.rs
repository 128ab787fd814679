//! Elimination of a body that hangs by one point: the commonest joint, in 3×3 blocks, for one body or four.
//!
//! Let c be the body, p its parent, r and s the arms from their centres of mass to the common point, (A, B, C) c's
//! articulated mass (`spatial.rs`). With u the acceleration of the point instead of the centre's, ω̇ unchanged,
//!
//! ```text
//! v̇ = u + [r]× ω̇,   τ' = τ − r × f:    [ f + λ ]   [ A   Q  ] [ u ]      Q = B + A [r]×
//!                                       [ τ'    ] = [ Qᵀ  C' ] [ ω̇ ]      C' = C − ([r]× B)ᵀ − [r]× Q
//! ω̇ = C'⁻¹ τ' − Lᵀ u                          L = Q C'⁻¹
//! λ = N u − (f − L τ')                        N = A − L Qᵀ
//! ```
//!
//! N is the mass that the point feels. The joint asks u = g + (v̇_p + ω̇_p × s), so the parent is left with
//!
//! ```text
//! A_p += N      B_p += −N [s]×      C_p += −[s]× N [s]×
//! f_p += w      τ_p += s × w        w = f − L τ' − N g
//! ```
//!
//! This is the general elimination of `tree.rs` for the rows J_c = `(E, −r×)`; here nothing larger than 3×3 is
//! inverted. A test holds the two against each other.

use soffio_math::lanes::{Four, Lanes, Real, V3};
use soffio_math::spatial::Vec6;
use soffio_math::spatial::{Articulated, M3, Sym3};

/// Where the point is, as seen from both bodies.
#[derive(Clone, Copy, Debug, Default)]
pub struct Arms<T> {
    /// r: from the body's centre of mass to the point, world axes, m.
    pub own: V3<T>,
    /// s: from the parent's centre of mass to the point, world axes, m.
    pub parent: V3<T>,
}

/// Factor of such a body.
#[derive(Clone, Copy, Debug, Default)]
pub struct Ball<T> {
    /// r and s.
    pub arms: Arms<T>,
    /// C'⁻¹.
    free: Sym3<T>,
    /// L.
    lever: M3<T>,
    /// N.
    point_mass: Sym3<T>,
}

/// What is known of the points by which four bodies hang, as seen from them, and what goes through them in a solve.
#[derive(Clone, Copy, Debug, Default)]
pub struct Points {
    /// C at the last evaluation.
    pub value: V3<Four>,
    /// J̇ẋ there.
    pub bias: V3<Four>,
    /// g, where it is neither of these.
    pub wanted: V3<Four>,
    /// τ' on the way up.
    pub torque: V3<Four>,
    /// w on the way up, then λ.
    pub force: V3<Four>,
}

/// What the points are to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// To close: g = −C.
    Closed,
    /// To stay: g = −J̇ẋ.
    Still,
    /// Nothing: g = 0.
    Nothing,
    /// What they have been told.
    Told,
}

/// Force and torque, or the linear and angular parts of an acceleration.
#[derive(Clone, Copy, Debug, Default)]
pub struct Twist<T> {
    /// Linear part.
    pub linear: V3<T>,
    /// Angular part.
    pub angular: V3<T>,
}

impl<T: Real> Ball<T> {
    /// Eliminates the body of this articulated mass.
    #[inline(always)]
    pub fn factor(arms: Arms<T>, mass: &Articulated<T>) -> Self {
        let r = arms.own;
        let b = &mass.b;
        let y = mass.a.mul_skew(r);
        let q = M3 { x: b.x + y.x, y: b.y + y.y, z: b.z + y.z };
        // Entry (i, j) of C' needs component j of r × b_i and component i of r × q_j.
        let (bx, by, bz) = (r.cross(b.x), r.cross(b.y), r.cross(b.z));
        let (qx, qy, qz) = (r.cross(q.x), r.cross(q.y), r.cross(q.z));
        let spin = Sym3 {
            d: mass.c.d - V3::new(bx.x + qx.x, by.y + qy.y, bz.z + qz.z),
            o: mass.c.o - V3::new(by.z + qz.y, bx.z + qz.x, bx.y + qy.x),
        };
        let free = spin.inverse();
        let (gx, gy, gz) = (free.x(), free.y(), free.z());
        let lever = M3 { x: q.mul(gx), y: q.mul(gy), z: q.mul(gz) };
        let taken = Sym3::product(&lever, &q);
        let point_mass = Sym3 { d: mass.a.d - taken.d, o: mass.a.o - taken.o };
        Self { arms, free, lever, point_mass }
    }

    /// What the parent feels of the body.
    #[inline(always)]
    pub fn load(&self) -> Articulated<T> {
        let (n, s) = (self.point_mass, self.arms.parent);
        let y = n.mul_skew(s);
        // −[s]× N [s]×, column by column s × (−y).
        let b = M3 { x: -y.x, y: -y.y, z: -y.z };
        let (x, y, z) = (y.x, y.y, y.z);
        let c = Sym3 {
            d: -V3::new(s.cross(x).x, s.cross(y).y, s.cross(z).z),
            o: -V3::new(s.cross(y).z, s.cross(x).z, s.cross(x).y),
        };
        Articulated { a: n, b, c }
    }

    /// Towards the root: the wrench `b` on the body and the wanted `g` become τ' and the force w on the parent's point.
    #[inline(always)]
    pub fn up(&self, b: Twist<T>, g: V3<T>) -> (V3<T>, V3<T>) {
        let torque = b.angular - self.arms.own.cross(b.linear);
        (torque, b.linear - self.lever.mul(torque) - self.point_mass.mul(g))
    }

    /// Wrench on the parent of a force at the point.
    #[inline(always)]
    pub fn wrench(&self, w: V3<T>) -> Twist<T> {
        Twist { linear: w, angular: self.arms.parent.cross(w) }
    }

    /// Towards the leaves: the body's acceleration and λ from the parent's `a`, the body's own `g`, τ' and w.
    #[inline(always)]
    pub fn down(&self, g: V3<T>, (torque, w): (V3<T>, V3<T>), parent: Twist<T>) -> (Twist<T>, V3<T>) {
        let carried = parent.linear + parent.angular.cross(self.arms.parent);
        let lambda = self.point_mass.mul(carried) - w;
        let u = g + carried;
        let turn = self.free.mul(torque) - self.lever.transposed_mul(u);
        (Twist { linear: u - turn.cross(self.arms.own), angular: turn }, lambda)
    }
}

impl<T: Real> Twist<T> {
    /// Of each body.
    #[inline(always)]
    pub fn gather<'a, L: Lanes<T = T>>(lanes: L, of: impl Fn(usize) -> &'a Vec6) -> Self {
        let [x, y, z, a, b, c] = lanes.rows(of);
        Self { linear: V3 { x, y, z }, angular: V3 { x: a, y: b, z: c } }
    }

    /// The six numbers.
    #[inline(always)]
    pub fn numbers(&self) -> [T; 6] {
        let (l, a) = (&self.linear, &self.angular);
        [l.x, l.y, l.z, a.x, a.y, a.z]
    }
}

impl Twist<Four> {
    /// Reads.
    #[inline(always)]
    pub fn get<L: Lanes>(&self, lanes: L) -> Twist<L::T> {
        Twist { linear: self.linear.get(lanes), angular: self.angular.get(lanes) }
    }

    /// Writes.
    #[inline(always)]
    pub fn put<L: Lanes>(&mut self, lanes: L, twist: &Twist<L::T>) {
        self.linear.put(lanes, twist.linear);
        self.angular.put(lanes, twist.angular);
    }
}

impl Points {
    /// g.
    #[inline(always)]
    pub fn wanted<L: Lanes>(&self, lanes: L, wanted: Wanted) -> V3<L::T> {
        match wanted {
            Wanted::Closed => -self.value.get(lanes),
            Wanted::Still => -self.bias.get(lanes),
            Wanted::Nothing => {
                let zero = lanes.gather(|_| 0.0);
                V3 { x: zero, y: zero, z: zero }
            }
            Wanted::Told => self.wanted.get(lanes),
        }
    }
}

impl Arms<Four> {
    /// Reads.
    #[inline(always)]
    pub fn get<L: Lanes>(&self, lanes: L) -> Arms<L::T> {
        Arms { own: self.own.get(lanes), parent: self.parent.get(lanes) }
    }

    /// Writes.
    #[inline(always)]
    pub fn put<L: Lanes>(&mut self, lanes: L, arms: &Arms<L::T>) {
        self.own.put(lanes, arms.own);
        self.parent.put(lanes, arms.parent);
    }
}

impl Ball<Four> {
    /// Reads.
    #[inline(always)]
    pub fn get<L: Lanes>(&self, lanes: L) -> Ball<L::T> {
        Ball {
            arms: self.arms.get(lanes),
            free: self.free.get(lanes),
            lever: self.lever.get(lanes),
            point_mass: self.point_mass.get(lanes),
        }
    }

    /// Writes all but the arms, which are known.
    #[inline(always)]
    pub fn put_factor<L: Lanes>(&mut self, lanes: L, ball: &Ball<L::T>) {
        self.free.put(lanes, &ball.free);
        self.lever.put(lanes, &ball.lever);
        self.point_mass.put(lanes, &ball.point_mass);
    }
}
