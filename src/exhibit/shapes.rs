//! Key frames that change shapes: scales of nodes and weights of morph targets (glTF 2.0, 3.7.2.2 and 3.11).
//!
//! Bodies are rigid, so physics, wind and hands keep what stands at rest, and the picture alone shows these, at the time since
//! the reset. They need no word in the sidecar: what is below a kinematic body goes on with the animation that the body
//! follows, anything else with the first of the model that has such key frames, over and over.

use super::model::{Channel, Model, Track};

/// Key frames of one shape, and how they go on.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeTrack {
    /// A scale or weights.
    pub channel: Channel,
    /// First and last key of all its animation, s: what is in one animation begins anew together.
    pub span: (f64, f64),
    /// Does it begin anew after the last?
    pub repeat: bool,
}

impl ShapeTrack {
    /// The time in the animation at `t` seconds after the reset.
    pub fn time(&self, t: f64) -> f64 {
        let (first, last) = self.span;
        let length = last - first;
        if self.repeat && length > 0.0 { t - length * ((t - first) / length).floor() } else { t }
    }

    /// May the shape be another one after `t` seconds?
    pub fn moves(&self, t: f64) -> bool {
        let (first, last) = self.span;
        last > first && (self.repeat || t < last)
    }
}

/// The key frames of all shapes of a model. `followed` tells of a node the animation that its body follows, and whether over and
/// over.
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
        let span = (times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max));
        if let Some(chosen) = channels.iter().find(|other| alike(other, channel)) {
            tracks.push(ShapeTrack { channel: chosen.clone(), span, repeat });
        }
    }
    tracks
}

/// Are these of the same property of the same node?
fn alike(a: &Channel, b: &Channel) -> bool {
    let same =
        matches!((&a.track, &b.track), (Track::Scale(..), Track::Scale(..)) | (Track::Weights(_), Track::Weights(_)));
    same && a.node == b.node
}
