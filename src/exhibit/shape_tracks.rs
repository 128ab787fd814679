//! Animated shapes: key frames of node scales and of morph-target weights (glTF 2.0, 3.7.2.2 and 3.11).
//!
//! Bodies are rigid: physics, wind and grabs use the shape at rest, and the picture alone shows animated shapes, by the
//! time since the reset. The sidecar needs no key for them. Nodes below a kinematic body play the animation that the
//! body follows. All others loop the first animation of the model that has such key frames.

use super::model::{Channel, Model, Track};

/// The key frames of one shape and how they repeat.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeTrack {
    /// The channel: a scale or morph weights.
    pub channel: Channel,
    /// First key of the whole animation, s: its channels repeat together.
    pub first_key: f64,
    /// Last key of the whole animation, s.
    pub last_key: f64,
    /// Does it start again after the last key?
    pub repeat: bool,
}

impl ShapeTrack {
    /// Time in the animation at `t` seconds after the reset, s.
    pub fn time(&self, t: f64) -> f64 {
        let Self { first_key: first, last_key: last, .. } = *self;
        let length = last - first;
        if self.repeat && length > 0.0 { t - length * ((t - first) / length).floor() } else { t }
    }

    /// Can the shape still change after `t` seconds?
    pub fn is_changing(&self, t: f64) -> bool {
        let Self { first_key: first, last_key: last, .. } = *self;
        last > first && (self.repeat || t < last)
    }
}

/// The animated shapes of a model. `followed` gives, for a node, the animation that its body follows and whether it
/// repeats.
pub fn shapes(model: &Model, followed: impl Fn(usize) -> Option<(usize, bool)>) -> Vec<ShapeTrack> {
    let mut tracks: Vec<ShapeTrack> = Vec::new();
    let keyed = model.animations.iter().flat_map(|animation| &animation.channels).filter(|channel| channel.shapes());
    for channel in keyed {
        if tracks.iter().any(|known| alike(&known.channel, channel)) {
            continue;
        }
        let has = |index: &usize| model.animations[*index].channels.iter().any(|other| alike(other, channel));
        let followed = followed(channel.node).filter(|(index, _)| has(index));
        let Some((index, repeat)) = followed.or_else(|| (0..model.animations.len()).find(has).map(|i| (i, true)))
        else {
            continue;
        };
        let channels = &model.animations[index].channels;
        let times = || channels.iter().flat_map(|channel| &channel.times).copied();
        let first_key = times().fold(f64::INFINITY, f64::min);
        let last_key = times().fold(0.0, f64::max);
        if let Some(chosen) = channels.iter().find(|other| alike(other, channel)) {
            tracks.push(ShapeTrack { channel: chosen.clone(), first_key, last_key, repeat });
        }
    }
    tracks
}

/// Do both animate the same property of the same node?
fn alike(a: &Channel, b: &Channel) -> bool {
    let same =
        matches!((&a.track, &b.track), (Track::Scale(..), Track::Scale(..)) | (Track::Weights(_), Track::Weights(_)));
    same && a.node == b.node
}
