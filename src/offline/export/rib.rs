//! RenderMan export: a run as one RIB file for each frame (RenderMan Interface Specification 3.2).
//!
//! A frame contains camera, lamps, the gallery's walls, and each mesh as an archive (`meshes/`), placed at the body's
//! poses when the shutter opens and closes. The shutter is open for half a frame. RIB's camera looks along +z with x to
//! the right and y up, and points are rows, p′ = p M. Surfaces are the standard's `matte`, `plastic`, `metal` and
//! `constant`, lamps its `spotlight`. These have no texture images, which are left out.

use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use super::super::atomic_file::AtomicFile;
use super::export_model::ExportModel;
use soffio_exhibit::model::{Appearance, LightKind, Primitive};
use soffio_exhibit::{Exhibit, View};
use soffio_math::{DMat4, DVec3, PI, Pose, acos};
use soffio_render::gallery::{FLOOR_ALBEDO, Face, Gallery, WALL_ALBEDO};

/// Fraction of a frame in which the shutter is open.
const SHUTTER: f64 = 0.5;
/// Samples a pixel in each direction; motion blur needs more than static scenes.
const SAMPLES: u32 = 6;
/// Gamma of the rendered pictures.
const GAMMA: f64 = 2.2;
/// Metalness above which a surface is rendered as metal.
const METAL: f32 = 0.5;
/// Near plane of the camera, m.
const NEAR: f64 = 0.01;
/// Faces of the gallery that the camera can see.
const WALLS: [Face; 5] = [Face::Wall, Face::Floor, Face::Ceiling, Face::Left, Face::Right];

/// Writes RIB files during a run.
pub struct RibWriter<'a> {
    exhibit: &'a Exhibit,
    folder: PathBuf,
    size: (u32, u32),
    fps: u32,
    /// Constant part of each frame: camera, lamps, walls.
    head: String,
    /// Body, attributes and archive of each mesh.
    parts: Vec<(Option<usize>, String)>,
    open: Option<Vec<Pose>>,
}

impl<'a> RibWriter<'a> {
    /// Starts the frames in `folder` (created if missing), pictures of `size` pixels, `fps` a second.
    ///
    /// # Errors
    /// The folder or the files of the scene cannot be written.
    pub fn create(exhibit: &'a Exhibit, folder: &Path, size: (u32, u32), fps: u32) -> io::Result<Self> {
        std::fs::create_dir_all(folder.join("meshes"))
            .map_err(|e| io::Error::new(e.kind(), format!("cannot make the folder {}: {e}", folder.display())))?;
        let export_model = ExportModel::new(exhibit);
        let mut parts = Vec::new();
        for piece in export_model.placed_primitives(exhibit) {
            for primitive in piece.mesh.primitives.iter().filter(|primitive| !primitive.indices.is_empty()) {
                let archive = format!("meshes/{:04}.rib", parts.len());
                write(&folder.join(&archive), &polygons(primitive, &piece.place))?;
                let look =
                    primitive.material.and_then(|m| export_model.model.materials.get(m)).cloned().unwrap_or_default();
                parts.push((piece.body, format!("{}    ReadArchive \"{archive}\"\n", surface(&look))));
            }
        }
        let view = exhibit.view(f64::from(size.0) / f64::from(size.1));
        let head = gallery(&Gallery::around(exhibit), &view) + &punctual(exhibit, &export_model);
        Ok(Self { exhibit, folder: folder.into(), size, fps, head, parts, open: None })
    }

    /// Number of [`Self::push`] calls a second: both ends of each shutter interval.
    pub fn samples_per_second(&self) -> u32 {
        2 * self.fps
    }

    /// Takes the poses of the next sample, in the order of the exhibit's bodies; every second one completes a frame.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn push(&mut self, number: u64, poses: &[Pose]) -> io::Result<()> {
        match self.open.take() {
            None => self.open = Some(poses.to_vec()),
            Some(open) => {
                let frame = number / 2;
                let text = self.frame(frame, &open, poses);
                write(&self.folder.join(format!("frame.{frame:06}.rib")), &text)?;
            }
        }
        Ok(())
    }

    fn frame(&self, number: u64, open: &[Pose], closed: &[Pose]) -> String {
        let (width, height) = self.size;
        let aspect = f64::from(width) / f64::from(height);
        let view = self.exhibit.view(aspect);
        let (opens, closes) = (0.0, SHUTTER / f64::from(self.fps));
        let mut out = format!(
            "##RenderMan RIB-Structure 1.1\n##Scene {}\n##Frames 1\nversion 3.03\n\
             FrameBegin {}\n  Display \"frame.{number:06}.tif\" \"file\" \"rgb\"\n  Format {width} {height} 1\n  \
             ScreenWindow {} {} -1 1\n  Clipping {NEAR} 1000\n  PixelSamples {SAMPLES} {SAMPLES}\n  \
             PixelFilter \"gaussian\" 2 2\n  ShadingRate 1\n  Exposure 1 {GAMMA}\n  Quantize \"rgb\" 255 0 255 0.5\n  \
             Shutter {opens} {closes}\n  Projection \"perspective\" \"fov\" [{}]\n  ConcatTransform {}\n  WorldBegin\n",
            self.exhibit.id.replace(['\n', '"'], " "),
            number + 1,
            -aspect,
            aspect,
            view.fovy.to_degrees(),
            camera(&view),
            opens = opens,
            closes = closes,
        );
        out += &self.head;
        for (body, part) in &self.parts {
            out += "  AttributeBegin\n";
            if let Some(body) = *body {
                let [from, to] = [open, closed].map(|poses| rows(&poses[body].matrix()));
                // Static meshes need no motion blur.
                let _ = if from == to {
                    writeln!(out, "    ConcatTransform {from}")
                } else {
                    writeln!(
                        out,
                        "    MotionBegin [{opens} {closes}]\n      ConcatTransform {from}\n      ConcatTransform {to}\n    MotionEnd"
                    )
                };
            }
            out += part;
            out += "  AttributeEnd\n";
        }
        out + "  WorldEnd\nFrameEnd\n"
    }
}

fn write(path: &Path, text: &str) -> io::Result<()> {
    let mut file = AtomicFile::create(path)?;
    file.write_all(text.as_bytes())?;
    file.finish()
}

/// A matrix for column vectors as one for RIB's row vectors.
fn rows(matrix: &DMat4) -> String {
    list(matrix.to_cols_array())
}

/// Numbers in brackets, nine digits each: more than single precision.
fn list(numbers: impl IntoIterator<Item = f64>) -> String {
    let mut out = String::from("[");
    for (i, number) in numbers.into_iter().enumerate() {
        // Writes −0 as 0.
        let _ = write!(out, "{}{}", if i == 0 { "" } else { " " }, (number * 1e9).round() / 1e9 + 0.0);
    }
    out + "]"
}

/// Transform from world to camera.
fn camera(view: &View) -> String {
    let (right, up, forward) = view.axes();
    let turned = DMat4::from_cols(right.extend(0.0), up.extend(0.0), forward.extend(0.0), glam::DVec4::W).transpose();
    rows(&(turned * DMat4::from_translation(-view.eye)))
}

/// Triangles in the frame of their body.
fn polygons(primitive: &Primitive, place: &DMat4) -> String {
    let normal_place = place.inverse().transpose();
    let vectors = |list: &[[f32; 3]]| -> Vec<DVec3> { list.iter().map(|v| DVec3::from(v.map(f64::from))).collect() };
    let points = vectors(&primitive.positions).into_iter().flat_map(|p| place.transform_point3(p).to_array());
    let normals = vectors(&primitive.normals)
        .into_iter()
        .flat_map(|n| normal_place.transform_vector3(n).try_normalize().unwrap_or(DVec3::Y).to_array());
    let triangles = primitive.indices.len() / 3;
    let mut out = format!(
        "PointsPolygons [{}] [{}]\n  \"P\" {}\n  \"N\" {}\n",
        vec!["3"; triangles].join(" "),
        primitive.indices.iter().map(u32::to_string).collect::<Vec<_>>().join(" "),
        list(points),
        list(normals),
    );
    if !primitive.colors.is_empty() {
        let colors = primitive.colors.iter().flat_map(|c| [c[0], c[1], c[2]]).map(f64::from);
        let _ = writeln!(out, "  \"Cs\" {}", list(colors));
    }
    out
}

fn surface(look: &Appearance) -> String {
    let rgb = |c: [f32; 3]| list(c.map(f64::from));
    let [r, g, b, _] = look.base_color;
    let through = 1.0 - look.transmission;
    let mut out = format!("    Sides 2\n    Opacity {}\n", rgb([through; 3]));
    let roughness = (look.roughness * look.roughness).max(0.02);
    let _ = if look.emissive != [0.0; 3] || look.unlit {
        let shown = if look.unlit { [r, g, b] } else { look.emissive };
        writeln!(out, "    Color {}\n    Surface \"constant\"", rgb(shown))
    } else if look.metallic > METAL {
        let shader = "\"metal\" \"Ka\" [1] \"Ks\" [1]";
        writeln!(out, "    Color {}\n    Surface {shader} \"roughness\" [{roughness}]", rgb([r, g, b]))
    } else {
        let shader = "\"plastic\" \"Ka\" [1] \"Kd\" [1] \"Ks\" [0.2]";
        writeln!(out, "    Color {}\n    Surface {shader} \"roughness\" [{roughness}]", rgb([r, g, b]))
    };
    out
}

/// The gallery: ambient light, its two lamps, its walls.
fn gallery(gallery: &Gallery, view: &View) -> String {
    let ambient = gallery.wall_ambient / WALL_ALBEDO.y;
    let mut out = format!("  LightSource \"ambientlight\" 1 \"intensity\" [{ambient}]\n");
    let vector = |v: glam::Vec3| list(v.as_dvec3().to_array());
    for (handle, lamp) in (2..).zip(&gallery.lamps) {
        let [inner, outer] = [lamp.cos_inner, lamp.cos_outer].map(|cosine| acos(f64::from(cosine)));
        // The standard surfaces reflect Kd Cs Cl cos θ, without the π of Lambert's law.
        let intensity = f64::from(lamp.intensity.y) / PI;
        let _ = writeln!(
            out,
            "  LightSource \"spotlight\" {handle} \"intensity\" [{intensity}] \"lightcolor\" {} \"from\" {} \"to\" {} \
             \"coneangle\" [{outer}] \"conedeltaangle\" [{}] \"beamdistribution\" [0]",
            vector(lamp.intensity / lamp.intensity.y),
            vector(lamp.position),
            vector(lamp.position + lamp.axis),
            outer - inner,
        );
    }
    for face in WALLS {
        let [a, b, middle] = gallery.face_axes(face);
        let corners = [middle - a - b, middle + a - b, middle + a + b, middle - a + b];
        let albedo = if face == Face::Floor { FLOOR_ALBEDO } else { WALL_ALBEDO };
        let points = in_front(&corners.map(|corner| gallery.to_world(corner).as_dvec3()), view);
        if points.is_empty() {
            continue;
        }
        let _ = writeln!(
            out,
            "  AttributeBegin\n    Sides 2\n    Color {}\n    Surface \"matte\" \"Ka\" [1] \"Kd\" [1]\n    Polygon \"P\" {}\n  \
             AttributeEnd",
            vector(albedo),
            list(points.into_iter().flat_map(|p| p.to_array()))
        );
    }
    out
}

/// The part of a polygon in front of the camera: renderers that dice surfaces on the screen cannot process the rest.
fn in_front(corners: &[DVec3], view: &View) -> Vec<DVec3> {
    let forward = view.axes().2;
    let depth = |p: DVec3| (p - view.eye).dot(forward) - NEAR;
    let mut out = Vec::new();
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (before, after) = (depth(a), depth(b));
        if before >= 0.0 {
            out.push(a);
        }
        if (before >= 0.0) != (after >= 0.0) {
            out.push(a.lerp(b, before / (before - after)));
        }
    }
    out
}

/// The model's own lights at their start positions.
fn punctual(exhibit: &Exhibit, export_model: &ExportModel) -> String {
    let mut out = String::new();
    let nodes = exhibit.model.nodes.iter();
    let lights = nodes.filter_map(|node| Some((node.world, export_model.model.lights.get(node.light?)?)));
    for (handle, (world, light)) in (10..).zip(lights) {
        let from = world.w_axis.truncate();
        let to = from - world.z_axis.truncate().try_normalize().unwrap_or(DVec3::Z);
        let [from, to] = [from, to].map(|p| list(p.to_array()));
        let level = format!(
            "{handle} \"intensity\" [{}] \"lightcolor\" {}",
            light.intensity / PI,
            list(light.color.to_array())
        );
        let _ = match light.kind {
            LightKind::Point => writeln!(out, "  LightSource \"pointlight\" {level} \"from\" {from}"),
            LightKind::Directional => {
                writeln!(out, "  LightSource \"distantlight\" {level} \"from\" {from} \"to\" {to}")
            }
            LightKind::Spot(inner, outer) => writeln!(
                out,
                "  LightSource \"spotlight\" {level} \"from\" {from} \"to\" {to} \"coneangle\" [{outer}] \
                 \"conedeltaangle\" [{}] \"beamdistribution\" [0]",
                outer - inner
            ),
        };
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_wall_that_passes_the_eye_the_part_before_it_is_drawn() {
        let view = View { eye: DVec3::ZERO, target: DVec3::NEG_Z, up: DVec3::Y, fovy: 0.5 };
        let wall = [
            DVec3::new(1.0, -1.0, -3.0),
            DVec3::new(1.0, -1.0, 3.0),
            DVec3::new(1.0, 1.0, 3.0),
            DVec3::new(1.0, 1.0, -3.0),
        ];
        let seen = in_front(&wall, &view);
        assert_eq!(seen.len(), 4);
        assert!(seen.iter().all(|p| p.x == 1.0 && p.z <= -NEAR + 1e-12), "{seen:?}");
        assert!(in_front(&wall.map(|p| DVec3::new(p.x, p.y, p.z.abs())), &view).is_empty());
    }

    #[test]
    fn the_centre_of_the_picture_lies_on_the_cameras_axis() {
        let view = View { eye: DVec3::new(1.0, 2.0, 3.0), target: DVec3::new(0.0, 2.0, -1.0), up: DVec3::Y, fovy: 0.5 };
        let text = camera(&view);
        let m: Vec<f64> = text.trim_matches(['[', ']']).split(' ').map(|x| x.parse().expect("a number")).collect();
        let seen = |p: DVec3| -> Vec<f64> {
            (0..3).map(|k| p.x * m[k] + p.y * m[4 + k] + p.z * m[8 + k] + m[12 + k]).collect()
        };
        let (middle, higher) = (seen(view.target), seen(view.target + DVec3::Y));
        let distance = view.eye.distance(view.target);
        // Nine decimals are written.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-7;
        assert!(near(middle[0], 0.0) && near(middle[1], 0.0) && near(middle[2], distance), "{middle:?}");
        assert!(near(higher[1], 1.0), "{higher:?}");
    }
}
