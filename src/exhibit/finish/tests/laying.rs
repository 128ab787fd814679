//! How finishes are laid on meshes, and which material a piece then has.

use std::collections::BTreeMap;

use super::super::*;
use crate::Exhibit;
use crate::model::{Appearance, Mesh, Model, Node, Primitive};
use soffio_math::{DMat4, DVec3};

/// A box with flat normals.
fn cuboid(size: [f32; 3]) -> Primitive {
    let mut out = Primitive::default();
    for axis in 0..3 {
        for side in [-1.0_f32, 1.0] {
            let base = out.positions.len() as u32;
            for (s, t) in [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)] {
                let mut corner = [0.0; 3];
                (corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (0.5 * side, s, t);
                out.positions.push([0, 1, 2].map(|k| corner[k] * size[k]));
                let mut normal = [0.0; 3];
                normal[axis] = side;
                out.normals.push(normal);
            }
            let order = if side > 0.0 { [0, 1, 2, 0, 2, 3] } else { [0, 2, 1, 0, 3, 2] };
            out.indices.extend(order.map(|k| base + k));
        }
    }
    out
}

/// A ball with smooth normals, whose vertices are shared by triangles of all axes.
fn ball(radius: f32) -> Primitive {
    const RINGS: u32 = 16;
    let mut out = Primitive::default();
    for j in 0..=RINGS {
        for i in 0..2 * RINGS {
            let (a, b) = (f64::from(i), f64::from(j));
            let (sin_b, cos_b) = soffio_math::sincos(soffio_math::PI * b / f64::from(RINGS));
            let (sin_a, cos_a) = soffio_math::sincos(soffio_math::PI * a / f64::from(RINGS));
            let normal = [sin_b * cos_a, cos_b, -sin_b * sin_a].map(|x| x as f32);
            out.positions.push(normal.map(|x| radius * x));
            out.normals.push(normal);
        }
    }
    for j in 0..RINGS {
        for i in 0..2 * RINGS {
            let at = |i: u32, j: u32| j * 2 * RINGS + i % (2 * RINGS);
            out.indices.extend([at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i + 1, j)]);
        }
    }
    out
}

const WOODEN: Laying = Laying { scale: DVec3::ONE, tile: [0.8, 0.25], end_tile: Some(0.1), offset: [0.3, 0.7] };

/// The triangles' corners with their normals, in the order of the file, however often vertices are doubled.
fn corners(parts: &[&Primitive]) -> BTreeMap<[[u32; 6]; 3], usize> {
    let mut out = BTreeMap::new();
    for part in parts {
        let bits = |i: u32| {
            let (p, n) = (part.positions[i as usize], part.normals[i as usize]);
            [p[0], p[1], p[2], n[0], n[1], n[2]].map(f32::to_bits)
        };
        for triangle in part.indices.as_chunks::<3>().0 {
            *out.entry(triangle.map(bits)).or_default() += 1;
        }
    }
    out
}

#[test]
fn the_surface_stays_and_ends_of_wood_become_a_part_of_their_own() {
    for (name, piece, ends) in [("a beam", cuboid([0.06, 0.5, 0.05]), 4), ("a ball", ball(0.1), 1)] {
        let laid = lay(&piece, &WOODEN);
        let end = laid.end.as_ref().expect("end grain");
        assert_eq!(corners(&[&piece]), corners(&[&laid.face, end]), "{name}");
        assert!(end.indices.len() / 3 >= ends, "{name}");
        for part in [&laid.face, end] {
            assert!(part.uvs.len() == part.positions.len() && part.tangents.len() == part.positions.len());
        }
        let without = lay(&piece, &Laying { end_tile: None, ..WOODEN });
        assert!(without.end.is_none(), "{name} of metal");
        assert_eq!(corners(&[&piece]), corners(&[&without.face]), "{name} of metal");
    }
    let beam = lay(&cuboid([0.06, 0.5, 0.05]), &WOODEN);
    let end = beam.end.expect("end grain");
    assert!(end.normals.iter().all(|n| n[1].abs() == 1.0), "the grain runs along y");
}

#[test]
fn a_plate_keeps_its_vertices() {
    // Thin; and thick, but mostly its two flat sides: 2·0.16/(2·0.16 + 4·0.4·0.06) = 77 %.
    for thickness in [0.002, 0.06] {
        let plate = cuboid([0.4, 0.4, thickness]);
        let laid = lay(&plate, &WOODEN);
        assert!(laid.end.is_none());
        assert_eq!(laid.face.positions, plate.positions);
        assert_eq!(laid.face.normals, plate.normals);
        assert_eq!(laid.face.indices, plate.indices);
    }
    assert!(lay(&cuboid([0.4, 0.4, 0.2]), &WOODEN).end.is_some(), "a block is none");
}

/// Area of a triangle over that of its texture coordinates, m².
fn densities(primitive: &Primitive) -> Vec<f64> {
    let at = |i: u32| {
        let (p, uv) = (primitive.positions[i as usize], primitive.uvs[i as usize]);
        (DVec3::from(p.map(f64::from)), uv.map(f64::from))
    };
    let density = |[a, b, c]: [u32; 3]| {
        let ((a, ta), (b, tb), (c, tc)) = (at(a), at(b), at(c));
        let area = 0.5 * (b - a).cross(c - a).length();
        let on = 0.5 * ((tb[0] - ta[0]) * (tc[1] - ta[1]) - (tc[0] - ta[0]) * (tb[1] - ta[1])).abs();
        area / on
    };
    primitive.indices.as_chunks::<3>().0.iter().map(|t| density(*t)).collect()
}

#[test]
fn a_tile_has_its_size_on_every_side_of_a_box() {
    /// Single precision of coordinates near 1, for edges of millimetres.
    const ROUNDING: f64 = 1e-3;
    let [length, width] = WOODEN.tile;
    let beam = lay(&cuboid([0.06, 0.5, 0.05]), &WOODEN);
    let plate = lay(&cuboid([0.4, 0.3, 0.02]), &WOODEN);
    for (part, tile) in [
        (&beam.face, length * width),
        (beam.end.as_ref().expect("end grain"), 0.1 * 0.1),
        (&plate.face, length * width),
    ] {
        for density in densities(part) {
            assert!((density / tile - 1.0).abs() < ROUNDING, "{density} m² instead of {tile}");
        }
    }
    // A model in millimetres, scaled by its node, gets the same coordinates.
    let mut millimeters = cuboid([60.0, 500.0, 50.0]);
    let scaled = lay(&millimeters, &Laying { scale: DVec3::splat(1e-3), ..WOODEN });
    millimeters.uvs = beam.face.uvs.clone();
    for (a, b) in scaled.face.uvs.iter().zip(&millimeters.uvs) {
        assert!((a[0] - b[0]).abs() < 1e-5 && (a[1] - b[1]).abs() < 1e-5, "{a:?} {b:?}");
    }
}

#[test]
fn tangents_point_along_u_and_bitangents_against_v() {
    for piece in [cuboid([0.06, 0.5, 0.05]), ball(0.1), cuboid([0.4, 0.3, 0.002])] {
        let laid = lay(&piece, &WOODEN);
        for part in [Some(&laid.face), laid.end.as_ref()].into_iter().flatten() {
            for triangle in part.indices.as_chunks::<3>().0 {
                let [a, b, c] = triangle.map(|i| i as usize);
                let place = |i: usize| DVec3::from(part.positions[i].map(f64::from));
                let [e, f] = [b, c].map(|i| place(i) - place(a));
                let [du, dv] = [0, 1].map(|k| [b, c].map(|i| f64::from(part.uvs[i][k] - part.uvs[a][k])));
                let turned = du[0] * dv[1] - du[1] * dv[0];
                // The poles of a ball have triangles without an area.
                if e.cross(f).length() < 1e-9 {
                    continue;
                }
                let along_u = (e * dv[1] - f * dv[0]) / turned;
                let along_v = (f * du[0] - e * du[1]) / turned;
                for i in [a, b, c] {
                    let normal = DVec3::from(part.normals[i].map(f64::from));
                    let [x, y, z, hand] = part.tangents[i].map(f64::from);
                    let tangent = DVec3::new(x, y, z);
                    assert!(tangent.dot(normal).abs() < 1e-5 && (tangent.length() - 1.0).abs() < 1e-5);
                    assert!(tangent.dot(along_u) > 0.0, "{tangent} {along_u}");
                    assert!((normal.cross(tangent) * hand).dot(along_v) < 0.0, "{normal} {tangent} {hand} {along_v}");
                }
            }
        }
    }
}

/// A model of pieces with these materials; each node shows the mesh of its number.
fn model(meshes: Vec<Primitive>, shown: &[usize], materials: Vec<Appearance>) -> Model {
    let node = |(index, mesh): (usize, &usize)| Node {
        name: format!("Piece{index}"),
        parent: None,
        children: Vec::new(),
        local: DMat4::IDENTITY,
        world: DMat4::IDENTITY,
        mesh: Some(*mesh),
        camera: None,
        light: None,
    };
    let mesh = |primitive| Mesh { name: "piece".into(), primitives: vec![primitive] };
    Model {
        nodes: shown.iter().enumerate().map(node).collect(),
        roots: (0..shown.len()).collect(),
        meshes: meshes.into_iter().map(mesh).collect(),
        materials,
        ..Model::default()
    }
}

#[test]
fn extras_keep_the_models_colour_and_a_sidecar_brings_the_finishs() {
    let look = Appearance {
        base_color: [0.5, 0.3, 0.2, 1.0],
        metallic: 0.0,
        roughness: 0.5,
        finish: named("beech"),
        ..Appearance::default()
    };
    let piece = || Primitive { material: Some(0), ..cuboid([0.06, 0.5, 0.05]) };
    let worn = |model: &Model, node: usize| {
        let primitive = &model.meshes[model.nodes[node].mesh.expect("a mesh")].primitives[0];
        model.materials[primitive.material.expect("a material")].clone()
    };
    let own = Exhibit::from_model(model(vec![piece()], &[0], vec![look.clone()])).model;
    let beech = named("beech").expect("beech").maps();
    let after = worn(&own, 0);
    for k in 0..3 {
        let mean = after.base_color[k] * beech.color_mean[k];
        assert!((mean - look.base_color[k]).abs() < 1e-6, "{mean}");
    }
    assert!((after.roughness * beech.roughness_mean - 0.5).abs() < 1e-6);
    assert_eq!(own.images.len(), 6, "three of faces and three of ends");

    let oak = named("oak").expect("oak");
    let mut chosen = model(vec![piece()], &[0, 0], vec![look]);
    let red = Some([0.6, 0.02, 0.01]);
    let changed = dress(&mut chosen, |node| match node {
        0 => Choice { finish: Some(oak), color: None },
        _ => Choice { finish: None, color: red },
    });
    assert_eq!(changed, [0, 1]);
    assert_ne!(chosen.nodes[0].mesh, chosen.nodes[1].mesh, "a shared mesh is dressed for each node");
    let [first, second] = [0, 1].map(|node| worn(&chosen, node));
    let usual = oak.linear_color().expect("a colour");
    assert!((first.base_color[0] * oak.maps().color_mean[0] - usual[0]).abs() < 1e-6);
    assert!((second.base_color[0] * beech.color_mean[0] - 0.6).abs() < 1e-6, "the model's finish, another colour");
}

#[test]
fn textures_glass_and_bending_meshes_stay() {
    let oak = named("oak");
    let looks = [
        Appearance { transmission: 0.9, metallic: 0.0, finish: oak, ..Appearance::default() },
        Appearance { base_color_texture: Some(crate::model::TextureUse::of(0)), finish: oak, ..Appearance::default() },
    ];
    for look in looks {
        let piece = Primitive { material: Some(0), ..cuboid([0.06, 0.5, 0.05]) };
        let mut one = model(vec![piece], &[0], vec![look]);
        let changed = dress(&mut one, |_| Choice { finish: oak, color: None });
        assert!(changed.is_empty() && one.materials.len() == 1 && one.meshes[0].primitives.len() == 1);
        assert!(one.meshes[0].primitives[0].uvs.is_empty());
    }
    let piece = Primitive { material: Some(0), ..cuboid([0.06, 0.5, 0.05]) };
    let mut skinned = model(vec![piece], &[0], vec![Appearance { finish: oak, ..Appearance::default() }]);
    skinned.skins.push(crate::model::Skin { node: 0, ..Default::default() });
    assert!(dress(&mut skinned, |_| Choice { finish: oak, color: None }).is_empty());
    assert!(skinned.meshes[0].primitives[0].uvs.is_empty());
}

#[test]
fn pieces_of_one_wood_differ_in_their_grain() {
    let look = Appearance { finish: named("pine"), ..Appearance::default() };
    let piece = Primitive { material: Some(0), ..cuboid([0.06, 0.5, 0.05]) };
    let exhibit = Exhibit::from_model(model(vec![piece], &[0, 0], vec![look]));
    let first =
        |node: usize| exhibit.model.meshes[exhibit.model.nodes[node].mesh.expect("a mesh")].primitives[0].uvs[0];
    assert_ne!(first(0), first(1));
}
