//! Key-frame animation of nodes: the channels of glTF 2.0 (section 3.11 and appendix C), decoded, and the world pose of
//! a node at any time.
//!
//! A cubic channel has an in-tangent a, a value v and an out-tangent b at each key; with d the span and s in 0 … 1
//!
//! ```text
//! p = (2s³ − 3s² + 1) v₀ + d (s³ − 2s² + s) b₀ + (3s² − 2s³) v₁ + d (s³ − s²) a₁
//! ```

use gltf::accessor::Dimensions;
use gltf::animation::Property;

use super::fault::{Cause, Fault};
use super::primitive::targets;
use super::scene::Model;
use super::{accessor, size};
use soffio_math::{DMat4, DQuat, DVec3};

/// An animation: channels that play together.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// Name, or `#index` where the file has none.
    pub name: String,
    /// The channels.
    pub channels: Vec<Channel>,
}

/// Key frames of one property of one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Index of the node.
    pub node: usize,
    /// Interpolation between two keys.
    pub curve: Curve,
    /// Times of the keys, s, increasing.
    pub times: Vec<f64>,
    /// The values: one for each key, or three (in-tangent, value, out-tangent) where the curve is cubic.
    pub track: Track,
}

/// Interpolation between two keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curve {
    /// The earlier value, until the next key.
    Step,
    /// Linear; for rotations, spherical along the shorter arc.
    Linear,
    /// A cubic Hermite curve.
    Cubic,
}

/// The values of a channel.
#[derive(Clone, Debug, PartialEq)]
pub enum Track {
    /// Translations of the node in its parent, m.
    Translation(Vec<DVec3>),
    /// Rotations of the node in its parent; cubic ones are not of unit length.
    Rotation(Vec<DQuat>),
    /// Scales of the node in its parent, with its rotation and translation (m) in the model: a matrix whose scale is
    /// zero has lost both.
    Scale(Vec<DVec3>, DQuat, DVec3),
    /// Weights of the morph targets of the node's mesh, one for each target.
    Weights(Vec<Vec<f64>>),
}

/// Bytes of a channel when decoded, by the stated counts: single precision, then double precision; a list of weights for each key
/// has a header.
pub(super) fn decoded_bytes(source: &gltf::animation::Channel) -> u64 {
    const HEADER: u64 = size_of::<Vec<f64>>() as u64;
    let sampler = source.sampler();
    let numbers = [sampler.input(), sampler.output()].iter().map(accessor::decoded_bytes).fold(0, u64::saturating_add);
    numbers.saturating_mul(3).saturating_add((sampler.output().count() as u64).saturating_mul(HEADER))
}

/// Decodes a channel.
pub(super) fn channel(source: &gltf::animation::Channel, buffers: &[Vec<u8>]) -> Result<Channel, accessor::ModelError> {
    let (target, sampler) = (source.target(), source.sampler());
    let output = sampler.output();
    let mut track = match target.property() {
        Property::Translation => {
            let values = accessor::vectors::<3>(&output, buffers, &[Dimensions::Vec3], 0.0)?;
            Track::Translation(values.iter().map(|v| DVec3::from(v.map(f64::from))).collect())
        }
        Property::Rotation => {
            let values = accessor::vectors::<4>(&output, buffers, &[Dimensions::Vec4], 0.0)?;
            Track::Rotation(values.iter().map(|v| DQuat::from_array(v.map(f64::from))).collect())
        }
        Property::Scale => {
            let values = accessor::vectors::<3>(&output, buffers, &[Dimensions::Vec3], 0.0)?;
            let (translation, rotation, _) = target.node().transform().decomposed();
            let rotation = DQuat::from_array(rotation.map(f64::from)).normalize();
            let values = values.iter().map(|v| DVec3::from(v.map(f64::from))).collect();
            Track::Scale(values, rotation, DVec3::from(translation.map(f64::from)))
        }
        Property::MorphTargetWeights => {
            let values = accessor::vectors::<1>(&output, buffers, &[Dimensions::Scalar], 0.0)?;
            let targets = targets(&target.node());
            let name = target.node().name().map_or_else(|| format!("#{}", target.node().index()), str::to_owned);
            if targets == 0 {
                let what = format_args!("it morphs node \"{name}\", which has no morph targets");
                return Err(Fault::new(Cause::Count, what));
            }
            if values.len() % targets != 0 {
                let count = values.len();
                let what =
                    format_args!("{count} weights of node \"{name}\" are not {targets} a key, one a morph target");
                return Err(Fault::new(Cause::Count, what));
            }
            Track::Weights(values.chunks(targets).map(|key| key.iter().map(|[w]| f64::from(*w)).collect()).collect())
        }
    };
    let times = accessor::vectors::<1>(&sampler.input(), buffers, &[Dimensions::Scalar], 0.0)?;
    let mut times: Vec<f64> = times.iter().map(|[t]| f64::from(*t)).collect();
    let curve = match sampler.interpolation() {
        gltf::animation::Interpolation::Step => Curve::Step,
        gltf::animation::Interpolation::Linear => Curve::Linear,
        gltf::animation::Interpolation::CubicSpline => Curve::Cubic,
    };
    let (values, each) = (track.len(), if curve == Curve::Cubic { 3 } else { 1 });
    if times.is_empty() || values != each * times.len() {
        let what = if matches!(track, Track::Weights(_)) { "lists of weights" } else { "values" };
        return Err(Fault::new(Cause::Count, format_args!("{} keys have {values} {what}", times.len())));
    }
    if accessor::is_empty(&sampler.input(), buffers) {
        // Without data all times are 0 (glTF 2.0, section 3.6.2.3): the first key stands for all.
        times.truncate(1);
        track.truncate(each);
    }
    let input = format!("accessors[{}]", sampler.input().index());
    if times[0] < 0.0 {
        return Err(Fault::at(
            Cause::Keys,
            input,
            format_args!("its first key is at {} s, before the start", times[0]),
        ));
    }
    if let Some(k) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
        let what = format_args!(
            "its keys are not in the order of time: key {} is at {} s, not after {} s",
            k + 1,
            times[k + 1],
            times[k]
        );
        return Err(Fault::at(Cause::Keys, input, what));
    }
    size::keys(&times, &track, curve == Curve::Cubic)?;
    if let Track::Rotation(values) = &track
        && curve != Curve::Cubic
        && values.iter().any(|q| q.length() == 0.0)
    {
        return Err(Fault::new(Cause::Range, "a rotation has no length"));
    }
    Ok(Channel { node: target.node().index(), curve, times, track })
}

impl Track {
    fn truncate(&mut self, length: usize) {
        match self {
            Self::Translation(values) | Self::Scale(values, ..) => values.truncate(length),
            Self::Rotation(values) => values.truncate(length),
            Self::Weights(values) => values.truncate(length),
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Translation(values) => values.len(),
            Self::Rotation(values) => values.len(),
            Self::Scale(values, ..) => values.len(),
            Self::Weights(values) => values.len(),
        }
    }
}

impl Channel {
    /// Index of the earlier key, of the later key, and the fraction of the span passed; before the first and after the
    /// last key, that key.
    fn interval(&self, t: f64) -> (usize, usize, f64) {
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

    /// Hermite weights of the earlier value and tangent and of the later ones.
    fn hermite(&self, (from, to, s): (usize, usize, f64)) -> [f64; 4] {
        let d = self.times[to] - self.times[from];
        let (s2, s3) = (s * s, s * s * s);
        [2.0 * s3 - 3.0 * s2 + 1.0, d * (s3 - 2.0 * s2 + s), 3.0 * s2 - 2.0 * s3, d * (s3 - s2)]
    }

    fn vector(&self, values: &[DVec3], t: f64) -> DVec3 {
        let interval @ (from, to, s) = self.interval(t);
        if self.curve == Curve::Cubic {
            let [v, b, w, a] = self.hermite(interval);
            return v * values[3 * from + 1] + b * values[3 * from + 2] + w * values[3 * to + 1] + a * values[3 * to];
        }
        values[from].lerp(values[to], s)
    }

    /// The scale at `t` seconds; `None` for another kind of channel.
    pub fn scale(&self, t: f64) -> Option<DVec3> {
        let Track::Scale(values, ..) = &self.track else { return None };
        Some(self.vector(values, t))
    }

    /// Sets the morph weights to those at `t` seconds; other kinds of channels leave them.
    pub fn sample_weights(&self, t: f64, weights: &mut [f64]) {
        let Track::Weights(values) = &self.track else { return };
        let interval @ (from, to, s) = self.interval(t);
        let [v, b, w, a] = if self.curve == Curve::Cubic { self.hermite(interval) } else { [1.0 - s, 0.0, s, 0.0] };
        let key = |index: usize| if self.curve == Curve::Cubic { 3 * index + 1 } else { index };
        for (i, weight) in weights.iter_mut().enumerate() {
            let of = |list: usize| values[list].get(i).copied().unwrap_or_default();
            *weight = v * of(key(from)) + w * of(key(to));
            if self.curve == Curve::Cubic {
                *weight += b * of(3 * from + 2) + a * of(3 * to);
            }
        }
    }

    /// Does it change a shape rather than a pose?
    pub fn shapes(&self) -> bool {
        matches!(self.track, Track::Scale(..) | Track::Weights(_))
    }

    fn rotation(&self, values: &[DQuat], t: f64) -> DQuat {
        let interval @ (from, to, s) = self.interval(t);
        if self.curve == Curve::Cubic {
            let [v, b, w, a] = self.hermite(interval);
            let sum = values[3 * from + 1] * v + values[3 * from + 2] * b + values[3 * to + 1] * w + values[3 * to] * a;
            return if sum.length() > 0.0 { sum.normalize() } else { DQuat::IDENTITY };
        }
        let (p, q) = (values[from].normalize(), values[to].normalize());
        let turn = q * p.conjugate();
        let turn = soffio_math::rotation_vector(if turn.w < 0.0 { -turn } else { turn });
        soffio_math::rotation(s * turn) * p
    }
}

impl Animation {
    /// The channels that move a node, its ancestors' included; scales count from ancestors alone.
    pub fn channels_of<'a>(&'a self, model: &Model, node: usize) -> Vec<&'a Channel> {
        let above: Vec<usize> = std::iter::successors(Some(node), |&n| model.nodes[n].parent).collect();
        let moves = |channel: &&Channel| match channel.track {
            Track::Translation(_) | Track::Rotation(_) => above.contains(&channel.node),
            Track::Scale(..) => above[1..].contains(&channel.node),
            Track::Weights(_) => false,
        };
        self.channels.iter().filter(moves).collect()
    }

    /// Transform from node to world at `t` seconds, with the node's own scale as in the model.
    pub fn world(&self, model: &Model, node: usize, t: f64) -> DMat4 {
        let above = std::iter::successors(Some(node), |&n| model.nodes[n].parent);
        above.fold(DMat4::IDENTITY, |below, n| self.local(model, n, n != node, t) * below)
    }

    fn local(&self, model: &Model, node: usize, grows: bool, t: f64) -> DMat4 {
        let local = model.nodes[node].local;
        let own = || self.channels.iter().filter(|channel| channel.node == node && (grows || !channel.shapes()));
        if own().next().is_none() {
            return local;
        }
        let (mut scale, mut rotation, mut translation) = local.to_scale_rotation_translation();
        for channel in own() {
            if let Track::Scale(values, turned, placed) = &channel.track {
                (scale, rotation, translation) = (channel.vector(values, t), *turned, *placed);
            }
        }
        for channel in own() {
            match &channel.track {
                Track::Translation(values) => translation = channel.vector(values, t),
                Track::Rotation(values) => rotation = channel.rotation(values, t),
                Track::Scale(..) | Track::Weights(_) => {}
            }
        }
        DMat4::from_scale_rotation_translation(scale, rotation, translation)
    }
}
