//! Gives the pieces of a model their finishes: materials with maps, and meshes with texture coordinates.
//!
//! It changes the picture and nothing else: nodes keep their places, and meshes their surface. So it comes last, when masses,
//! colliders and wind surfaces are known. What has a texture of its own, is transparent, or bends (skins, morph targets) stays as it
//! is.

use std::collections::BTreeMap;

use super::projection::{Laying, lay};
use super::{EndGrain, Finish, Maps};
use crate::model::{AlphaMode, Appearance, Mesh, Model, Node, Primitive, ScaledTexture, TextureUse};
use soffio_math::DVec3;
use soffio_math::noise::hash_words;

/// What a sidecar says of a node.
#[derive(Clone, Copy, Debug, Default)]
pub struct Choice {
    /// Its finish; `None` leaves it to the model.
    pub finish: Option<&'static Finish>,
    /// Its colour, linear RGB; `None` is the finish's or the model's.
    pub color: Option<[f32; 3]>,
}

/// Dresses a model. `choice` says what the sidecar wants for a node. Returns the nodes that have changed by it.
pub fn dress(model: &mut Model, choice: impl Fn(usize) -> Choice) -> Vec<usize> {
    let mut users = vec![0; model.meshes.len()];
    let shown = |node: &Node, meshes: usize| node.mesh.filter(|mesh| *mesh < meshes);
    model.nodes.iter().filter_map(|node| shown(node, model.meshes.len())).for_each(|mesh| users[mesh] += 1);
    let bent = |node: usize, model: &Model| {
        model.skins.iter().any(|skin| skin.node == node) || model.morphs.iter().any(|morph| morph.node == node)
    };
    let mut wardrobe = Wardrobe::default();
    let mut changed = Vec::new();
    for node in 0..model.nodes.len() {
        let Some(mesh) = shown(&model.nodes[node], model.meshes.len()).filter(|_| !bent(node, model)) else { continue };
        let choice = choice(node);
        let mut primitives = Vec::new();
        let mut any = false;
        for (number, primitive) in model.meshes[mesh].primitives.clone().into_iter().enumerate() {
            let look = primitive.material.and_then(|index| model.materials.get(index));
            let finish = choice.finish.or(look.and_then(|look| look.finish));
            let takes = look.is_none_or(|look| takes(look, finish)) && primitive.targets.is_empty();
            if !takes || (finish.is_none() && choice.color.is_none()) {
                primitives.push(primitive);
                continue;
            }
            any = true;
            let seed = hash_words(&[name_hash(&model.nodes[node].name), number as u64]);
            primitives.extend(wardrobe.dressed(model, node, &primitive, finish, choice, seed));
        }
        if !any {
            continue;
        }
        if choice.finish.is_some() || choice.color.is_some() {
            changed.push(node);
        }
        let name = model.meshes[mesh].name.clone();
        // A mesh that other nodes show too stays for them.
        users[mesh] -= 1;
        if users[mesh] == 0 {
            model.meshes[mesh].primitives = primitives;
        } else {
            model.nodes[node].mesh = Some(model.meshes.len());
            model.meshes.push(Mesh { name, primitives });
        }
    }
    changed
}

/// Can a finish, or a colour alone, be laid on a material?
fn takes(look: &Appearance, finish: Option<&Finish>) -> bool {
    let clear = look.transmission > 0.0 || look.alpha != AlphaMode::Opaque;
    let textured = look.base_color_texture.is_some()
        || look.metallic_roughness_texture.is_some()
        || look.normal_texture.is_some()
        || look.occlusion_texture.is_some()
        || look.emissive_texture.is_some()
        || !look.details.is_empty();
    finish.is_none() || !(clear || textured || look.unlit)
}

/// What a material is made from: that of the model, the finish, the sidecar's finish and colour, and whether it is end grain.
type Order = (Option<usize>, Option<&'static str>, bool, Option<[u32; 3]>, bool);

/// Materials and images that were made.
#[derive(Default)]
struct Wardrobe {
    materials: BTreeMap<Order, usize>,
    /// First of the three images of a finish, or of its end grain.
    images: BTreeMap<(&'static str, bool), usize>,
}

impl Wardrobe {
    /// The primitives that one becomes.
    fn dressed(
        &mut self,
        model: &mut Model,
        node: usize,
        primitive: &Primitive,
        finish: Option<&'static Finish>,
        choice: Choice,
        seed: u64,
    ) -> Vec<Primitive> {
        let world = model.nodes[node].world;
        let scale = DVec3::new(world.x_axis.length(), world.y_axis.length(), world.z_axis.length());
        let visible = scale.is_finite() && scale.min_element() > 0.0;
        let Some(finish) = finish.filter(|_| visible) else {
            let material = Some(self.material(model, primitive.material, None, choice, false));
            return vec![Primitive { material, ..primitive.clone() }];
        };
        let unit = |bits: u64| f64::from(bits as u32) / f64::from(u32::MAX);
        let laying = Laying {
            scale,
            tile: finish.tile,
            end_tile: finish.end.as_ref().map(|_| EndGrain::TILE),
            offset: [unit(seed), unit(seed >> 32)],
        };
        let laid = lay(primitive, &laying);
        let mut out = Vec::new();
        if !laid.face.indices.is_empty() {
            let material = Some(self.material(model, primitive.material, Some(finish), choice, false));
            out.push(Primitive { material, ..laid.face });
        }
        if let Some(end) = laid.end {
            let material = Some(self.material(model, primitive.material, Some(finish), choice, true));
            out.push(Primitive { material, ..end });
        }
        out
    }

    /// Index of a material.
    fn material(
        &mut self,
        model: &mut Model,
        from: Option<usize>,
        finish: Option<&'static Finish>,
        choice: Choice,
        end: bool,
    ) -> usize {
        let chosen = choice.finish.is_some();
        let order = (from, finish.map(|f| f.name), chosen, choice.color.map(|rgb| rgb.map(f32::to_bits)), end);
        if let Some(&made) = self.materials.get(&order) {
            return made;
        }
        // A primitive without a material is drawn as grey plastic.
        let plain = Appearance { metallic: 0.0, roughness: 0.6, ..Appearance::default() };
        let mut look = from.and_then(|index| model.materials.get(index)).cloned().unwrap_or(plain);
        let alpha = look.base_color[3];
        let usual = finish.filter(|_| chosen).and_then(Finish::linear_color);
        if let Some([r, g, b]) = choice.color.or(usual) {
            look.base_color = [r, g, b, alpha];
        }
        if let Some(finish) = finish {
            if chosen {
                (look.metallic, look.roughness) = (finish.metallic, finish.roughness);
            }
            let maps = match finish.end.as_ref().filter(|_| end) {
                Some(grain) => {
                    (0..3).for_each(|k| look.base_color[k] *= EndGrain::DARKER);
                    look.roughness *= EndGrain::ROUGHER;
                    grain.maps()
                }
                None => finish.maps(),
            };
            let image = *self.images.entry((finish.name, end)).or_insert_with(|| {
                model.images.extend([&maps.color, &maps.roughness, &maps.normal].map(std::sync::Arc::clone));
                model.images.len() - 3
            });
            wear(&mut look, maps, image);
        }
        model.materials.push(look);
        self.materials.insert(order, model.materials.len() - 1);
        model.materials.len() - 1
    }
}

/// Lays maps on a material, so that its mean colour and mean roughness stay.
fn wear(look: &mut Appearance, maps: &Maps, image: usize) {
    (0..3).for_each(|k| look.base_color[k] /= maps.color_mean[k]);
    look.roughness = (look.roughness / maps.roughness_mean).min(1.0);
    look.base_color_texture = Some(TextureUse::of(image));
    look.metallic_roughness_texture = Some(TextureUse::of(image + 1));
    look.normal_texture = Some(ScaledTexture { texture: TextureUse::of(image + 2), scale: maps.normal_scale });
}

/// A number of a name.
fn name_hash(name: &str) -> u64 {
    name.bytes().fold(0, |hash, byte| hash_words(&[hash, u64::from(byte)]))
}
