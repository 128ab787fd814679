//! Key frames of nodes: translation and rotation channels of glTF 2.0 (section 3.11 and appendix C), decoded, and the
//! world pose of a node at any time.
//!
//! A cubic channel has an in-tangent a, a value v and an out-tangent b at each key; with d the span and s in 0 … 1
//!
//! ```text
//! p = (2s³ − 3s² + 1) v₀ + d (s³ − 2s² + s) b₀ + (3s² − 2s³) v₁ + d (s³ − s²) a₁
//! ```

use gltf::accessor::Dimensions;
use gltf::animation::Property;

use super::{Model, accessor};
use crate::math::{DMat4, DQuat, DVec3};

/// Key frames that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// Name, or `#index` where the file has none.
    pub name: String,
    /// What moves.
    pub channels: Vec<Channel>,
}

/// Key frames of one property of one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// The node.
    pub node: usize,
    /// What happens between two keys.
    pub curve: Curve,
    /// s, rising.
    pub times: Vec<f64>,
    /// The values: one a key, or three (in-tangent, value, out-tangent) where the curve is cubic.
    pub track: Track,
}

/// What happens between two keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curve {
    /// The earlier value.
    Step,
    /// A straight line, or the shortest turn.
    Linear,
    /// A cubic Hermite curve.
    Cubic,
}

/// Values of a channel.
#[derive(Clone, Debug, PartialEq)]
pub enum Track {
    /// Of the node in its parent, m.
    Translation(Vec<DVec3>),
    /// Of the node in its parent; cubic ones are not of unit length.
    Rotation(Vec<DQuat>),
}

/// Decodes a channel; `None` for a property that rigid bodies do not have.
pub(super) fn channel(
    source: &gltf::animation::Channel,
    buffers: &[Vec<u8>],
) -> Result<Option<Channel>, accessor::Broken> {
    let (target, sampler) = (source.target(), source.sampler());
    let output = sampler.output();
    let track = match target.property() {
        Property::Translation => {
            let values = accessor::vectors::<3>(&output, buffers, &[Dimensions::Vec3], 0.0)?;
            Track::Translation(values.iter().map(|v| DVec3::from(v.map(f64::from))).collect())
        }
        Property::Rotation => {
            let values = accessor::vectors::<4>(&output, buffers, &[Dimensions::Vec4], 0.0)?;
            Track::Rotation(values.iter().map(|v| DQuat::from_array(v.map(f64::from))).collect())
        }
        Property::Scale | Property::MorphTargetWeights => return Ok(None),
    };
    let times = accessor::vectors::<1>(&sampler.input(), buffers, &[Dimensions::Scalar], 0.0)?;
    let times: Vec<f64> = times.iter().map(|[t]| f64::from(*t)).collect();
    let curve = match sampler.interpolation() {
        gltf::animation::Interpolation::Step => Curve::Step,
        gltf::animation::Interpolation::Linear => Curve::Linear,
        gltf::animation::Interpolation::CubicSpline => Curve::Cubic,
    };
    let (values, each) = (track.len(), if curve == Curve::Cubic { 3 } else { 1 });
    if times.is_empty() || values != each * times.len() {
        return Err(format!("{} keys have {values} values", times.len()));
    }
    if times[0] < 0.0 || times.windows(2).any(|pair| pair[0] >= pair[1]) {
        return Err("its keys are not in the order of time".into());
    }
    if let Track::Rotation(values) = &track
        && curve != Curve::Cubic
        && values.iter().any(|q| q.length() == 0.0)
    {
        return Err("a rotation has no length".into());
    }
    Ok(Some(Channel { node: target.node().index(), curve, times, track }))
}

impl Track {
    fn len(&self) -> usize {
        match self {
            Self::Translation(values) => values.len(),
            Self::Rotation(values) => values.len(),
        }
    }
}

impl Channel {
    /// Index of the earlier key, and the share of the span passed; before the first and after the last key, that key.
    fn place(&self, t: f64) -> (usize, usize, f64) {
        let last = self.times.len() - 1;
        let after = self.times.partition_point(|&time| time <= t);
        match after {
            0 => (0, 0, 0.0),
            after if after > last => (last, last, 0.0),
            after => {
                let (t0, t1) = (self.times[after - 1], self.times[after]);
                (after - 1, after, if self.curve == Curve::Step { 0.0 } else { (t - t0) / (t1 - t0) })
            }
        }
    }

    /// Weights of the out-going value and tangent and of the in-coming ones, for a cubic span.
    fn hermite(&self, (from, to, s): (usize, usize, f64)) -> [f64; 4] {
        let d = self.times[to] - self.times[from];
        let (s2, s3) = (s * s, s * s * s);
        [2.0 * s3 - 3.0 * s2 + 1.0, d * (s3 - 2.0 * s2 + s), 3.0 * s2 - 2.0 * s3, d * (s3 - s2)]
    }

    fn translation(&self, values: &[DVec3], t: f64) -> DVec3 {
        let place @ (from, to, s) = self.place(t);
        if self.curve == Curve::Cubic {
            let [v, b, w, a] = self.hermite(place);
            return v * values[3 * from + 1] + b * values[3 * from + 2] + w * values[3 * to + 1] + a * values[3 * to];
        }
        values[from].lerp(values[to], s)
    }

    fn rotation(&self, values: &[DQuat], t: f64) -> DQuat {
        let place @ (from, to, s) = self.place(t);
        if self.curve == Curve::Cubic {
            let [v, b, w, a] = self.hermite(place);
            let sum = values[3 * from + 1] * v + values[3 * from + 2] * b + values[3 * to + 1] * w + values[3 * to] * a;
            return if sum.length() > 0.0 { sum.normalize() } else { DQuat::IDENTITY };
        }
        let (p, q) = (values[from].normalize(), values[to].normalize());
        let turn = q * p.conjugate();
        let turn = crate::math::rotation_vector(if turn.w < 0.0 { -turn } else { turn });
        crate::math::rotation(s * turn) * p
    }
}

impl Animation {
    /// The channels that move a node, its ancestors' included.
    pub fn channels_of<'a>(&'a self, model: &Model, node: usize) -> Vec<&'a Channel> {
        let above: Vec<usize> = std::iter::successors(Some(node), |&n| model.nodes[n].parent).collect();
        self.channels.iter().filter(|channel| above.contains(&channel.node)).collect()
    }

    /// Node to world at `t` seconds.
    pub fn world(&self, model: &Model, node: usize, t: f64) -> DMat4 {
        let above = std::iter::successors(Some(node), |&n| model.nodes[n].parent);
        above.fold(DMat4::IDENTITY, |below, n| self.local(model, n, t) * below)
    }

    fn local(&self, model: &Model, node: usize, t: f64) -> DMat4 {
        let local = model.nodes[node].local;
        let mut own = self.channels.iter().filter(|channel| channel.node == node).peekable();
        if own.peek().is_none() {
            return local;
        }
        let (scale, mut rotation, mut translation) = local.to_scale_rotation_translation();
        for channel in own {
            match &channel.track {
                Track::Translation(values) => translation = channel.translation(values, t),
                Track::Rotation(values) => rotation = channel.rotation(values, t),
            }
        }
        DMat4::from_scale_rotation_translation(scale, rotation, translation)
    }
}
