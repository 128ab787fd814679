//! MJCF export: an exhibit as a MuJoCo model with bodies, inertias, joints, couplings, limits, springs, geoms and
//! contacts.
//!
//! The model has the exhibit's start pose, where all coordinates are 0. Joints form a tree (`tree`); loops are closed
//! by equality constraints; gears are fixed tendons of constant length. Features without a MuJoCo equivalent are left
//! out and listed: nothing is replaced by a mere approximation.
//!
//! | exhibit | MJCF |
//! |---|---|
//! | point, hinge, universal, slider, line, weld | `ball`, `hinge`, two `hinge`, `slide`, `slide` and `ball`, nothing |
//! | the same, closing a loop | `connect`, two of them, `weld` |
//! | coupling; backlash of a gear | `tendon/fixed` held by `equality/tendon`; limited |
//! | range; distance | `range`, or a limited tendon |
//! | spring | `tendon` with stiffness and damping |
//! | pair of colliders that can touch | `contact/pair` with the friction of both |

use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::Path;

use super::super::atomic_file::AtomicFile;
use soffio_exhibit::Exhibit;
use soffio_math::Function;
use soffio_math::{DQuat, DVec3, Pose};
use soffio_multibody::articulation::{Anchor, ConstraintKind, LimitKind, Measure, SpringKind};

mod shapes;
mod tree;

use tree::{Equality, Freedom, Tree};

/// Time step, s: MuJoCo's contacts and equalities are stiff springs with time constants of a few steps.
const STEP: f64 = 1e-3;
/// Value of a missing bound, rad or m.
const UNBOUNDED: f64 = 1e3;

/// An exported model.
pub struct Exported {
    /// MJCF.
    pub text: String,
    /// Names of the omitted features and the reasons, one line each.
    pub omitted: Vec<String>,
}

/// Writes the exhibit as MJCF; returns what was omitted.
///
/// # Errors
/// A file cannot be written.
pub fn write(exhibit: &Exhibit, path: &Path) -> io::Result<Vec<String>> {
    let Exported { text, omitted } = export(exhibit);
    let mut file = AtomicFile::create(path)?;
    file.write_all(text.as_bytes())?;
    file.finish()?;
    Ok(omitted)
}

/// The exhibit as a MuJoCo model.
pub fn export(exhibit: &Exhibit) -> Exported {
    let tree = Tree::new(exhibit);
    let mut writer = Writer {
        exhibit,
        tree: &tree,
        omitted: Vec::new(),
        sites: vec![String::new(); exhibit.bodies.len() + 1],
        site_count: 0,
        meshes: String::new(),
        tendons: String::new(),
        equalities: String::new(),
        ranges: Vec::new(),
        velocities: Vec::new(),
        places: Vec::new(),
    };
    for (name, why) in &tree.omitted {
        writer.omit(name, why);
    }
    writer.equalities();
    writer.couplings();
    writer.limits();
    writer.springs();
    let mut world = String::new();
    world += &shapes::geoms(exhibit, None, "    ", &mut writer.meshes);
    for &root in &tree.roots {
        writer.body(root, None, 2, &mut world);
    }
    let world_sites = std::mem::take(&mut writer.sites[0]);
    writer.report_unsupported();
    let gravity = numbers(&exhibit.gravity.to_array());
    let mut text = format!(
        "<mujoco model=\"{}\">\n  <compiler angle=\"radian\" balanceinertia=\"false\"/>\n  \
         <option timestep=\"{STEP}\" integrator=\"RK4\" gravity=\"{gravity}\"/>\n  <default>\n    \
         <equality solref=\"{} 1\" solimp=\"0.9999 0.9999 0.001 0.5 2\"/>\n    \
         <default class=\"collider\"><geom contype=\"0\" conaffinity=\"0\" mass=\"0\" group=\"0\" rgba=\"0.6 0.6 0.6 1\"/></default>\n    \
         <default class=\"wire\"><geom contype=\"0\" conaffinity=\"0\" mass=\"0\" group=\"1\"/></default>\n  </default>\n",
        escaped(&exhibit.id),
        2.0 * STEP
    );
    let pairs = pairs(exhibit);
    let key = writer.key();
    for (name, content) in [
        ("asset", &writer.meshes),
        ("worldbody", &(world_sites + &world)),
        ("tendon", &writer.tendons),
        ("equality", &writer.equalities),
        ("contact", &pairs),
        ("keyframe", &key),
    ] {
        if !content.is_empty() {
            let _ = write!(text, "  <{name}>\n{content}  </{name}>\n");
        }
    }
    text += "</mujoco>\n";
    Exported { text, omitted: writer.omitted }
}

struct Writer<'a> {
    exhibit: &'a Exhibit,
    tree: &'a Tree,
    omitted: Vec<String>,
    /// Sites: of the world, then of each body.
    sites: Vec<String>,
    site_count: usize,
    meshes: String,
    tendons: String,
    equalities: String,
    /// Ranges of joint coordinates: body, degree of freedom, least, greatest.
    ranges: Vec<(usize, usize, [f64; 2])>,
    /// Velocities and positions of all coordinates at the start, in the model's order.
    velocities: Vec<f64>,
    places: Vec<f64>,
}

impl Writer<'_> {
    fn omit(&mut self, name: &str, why: &str) {
        self.omitted.push(format!("{name}: {why}"));
    }

    /// Adds a site at a point and returns its name.
    fn site(&mut self, anchor: &Anchor) -> String {
        let name = format!("site {}", self.site_count);
        self.site_count += 1;
        let at = numbers(&anchor.point.to_array());
        let _ = writeln!(
            self.sites[anchor.body.map_or(0, |b| b + 1)],
            "<site {} pos=\"{at}\" size=\"0.001\"/>",
            named(&name)
        );
        name
    }

    fn equalities(&mut self) {
        for closing in &self.tree.equalities {
            match closing {
                Equality::Points(name, a, b) => {
                    let (a, b) = (self.site(a), self.site(b));
                    let _ = writeln!(self.equalities, "    <connect {} site1=\"{a}\" site2=\"{b}\"/>", named(name));
                }
                Equality::Rigid(name, a, b) => {
                    let [a, b] = [a, b]
                        .map(|body| escaped(body.map_or("world", |body| self.exhibit.bodies[body].name.as_str())));
                    let _ = writeln!(self.equalities, "    <weld {} body1=\"{a}\" body2=\"{b}\"/>", named(name));
                }
            }
        }
    }

    /// A sum of rotations and displacements as terms of joint coordinates; `None` where one of them is not a joint
    /// coordinate.
    fn sum(&self, terms: &[(Measure, f64)]) -> Option<Vec<(usize, usize, f64)>> {
        let mut all = Vec::new();
        for (measure, coefficient) in terms {
            let part = self.tree.coordinates(self.exhibit, measure)?;
            all.extend(part.into_iter().map(|(body, freedom, c)| (body, freedom, c * coefficient)));
        }
        Some(all)
    }

    /// Adds a tendon that measures a sum of coordinates, with further attributes.
    fn tendon(&mut self, name: &str, sum: &[(usize, usize, f64)], more: &str) {
        let _ = writeln!(self.tendons, "    <fixed {}{more}>", named(name));
        for (body, freedom, coefficient) in sum {
            let joint = escaped(&self.joint_name(*body, *freedom));
            let _ = writeln!(self.tendons, "      <joint joint=\"{joint}\" coef=\"{coefficient}\"/>");
        }
        self.tendons += "    </fixed>\n";
    }

    fn couplings(&mut self) {
        for constraint in &self.exhibit.constraints {
            let ConstraintKind::Coupling { terms } = &constraint.kind else { continue };
            if constraint.slips.is_some() {
                self.omit(&constraint.name, "slips");
                continue;
            }
            if !constraint.schedule.is_always() || constraint.breaking.is_some() {
                // A constraint with a schedule is reported by the tree.
                if constraint.schedule.is_always() {
                    self.omit(&constraint.name, "breaks");
                }
                continue;
            }
            let terms: Vec<_> = terms.iter().map(|term| (term.measure, term.coefficient)).collect();
            let Some(sum) = self.sum(&terms) else {
                self.omit(&constraint.name, "couples what no joint measures");
                continue;
            };
            self.tendon(&constraint.name, &sum, "");
            let name = named(&constraint.name);
            let _ = writeln!(self.equalities, "    <tendon {name} tendon1=\"{}\"/>", escaped(&constraint.name));
        }
    }

    fn limits(&mut self) {
        let limits = &self.exhibit.limits;
        for (index, limit) in limits.iter().enumerate() {
            // Limits of one constraint share its name.
            let name = format!("{} limit {index}", limit.name);
            let finite = |min: f64, max: f64| [min.max(-UNBOUNDED), max.min(UNBOUNDED)];
            let within = |[min, max]: [f64; 2]| format!(" limited=\"true\" range=\"{min} {max}\"");
            let why = match &limit.kind {
                LimitKind::Range { measure, min, max } => match self.sum(&[(*measure, 1.0)]).as_deref() {
                    Some(&[(body, freedom, c)]) if c.abs() == 1.0 => {
                        let [min, max] = finite(*min, *max);
                        self.ranges.push((body, freedom, if c > 0.0 { [min, max] } else { [-max, -min] }));
                        continue;
                    }
                    Some(sum) => {
                        self.tendon(&name, sum, &within(finite(*min, *max)));
                        continue;
                    }
                    None => "bounds what no joint measures",
                },
                LimitKind::Play { terms, play } => {
                    match self.sum(&terms.map(|term| (term.measure, term.coefficient))) {
                        Some(sum) => {
                            self.tendon(&name, &sum, &within([-0.5 * play, 0.5 * play]));
                            continue;
                        }
                        None => "plays between what no joint measures",
                    }
                }
                LimitKind::Distance { a, b, min, max } => {
                    let more = within(finite(*min, *max));
                    self.distance(&name, a, b, &more);
                    continue;
                }
                LimitKind::Tilt { .. } => "a bound on a tilt; MuJoCo bounds a ball joint's whole turn only",
                LimitKind::Ratchet { .. } => "a ratchet",
            };
            self.omit(&limit.name, why);
        }
    }

    /// Adds a tendon between two points.
    fn distance(&mut self, name: &str, a: &Anchor, b: &Anchor, more: &str) {
        let (a, b) = (self.site(a), self.site(b));
        let _ = writeln!(self.tendons, "    <spatial {}{more}>", named(name));
        let _ = writeln!(self.tendons, "      <site site=\"{a}\"/><site site=\"{b}\"/>\n    </spatial>");
    }

    fn springs(&mut self) {
        for spring in &self.exhibit.springs {
            let (Function::Constant(rest), Function::Constant(stiffness), Function::Constant(damping)) =
                (&spring.rest_length, &spring.stiffness, &spring.damping)
            else {
                self.omit(&spring.name, "a spring that changes with time");
                continue;
            };
            if !spring.schedule.is_always() || spring.breaking.is_some() {
                self.omit(&spring.name, "a spring that comes and goes, or breaks");
                continue;
            }
            let more = format!(" stiffness=\"{stiffness}\" damping=\"{damping}\" springlength=\"{rest}\"");
            match &spring.kind {
                SpringKind::Linear { a, b } => self.distance(&spring.name, a, b, &more),
                SpringKind::Angular { measure } => match self.sum(&[(*measure, 1.0)]) {
                    Some(sum) => self.tendon(&spring.name, &sum, &more),
                    None => self.omit(&spring.name, "a spring on what no joint measures"),
                },
            }
        }
    }

    fn joint_name(&self, body: usize, freedom: usize) -> String {
        format!("{} {freedom}", self.exhibit.bodies[body].name)
    }

    /// Writes a body and all bodies that it carries.
    fn body(&mut self, index: usize, parent: Option<usize>, depth: usize, out: &mut String) {
        let (exhibit, tree) = (self.exhibit, self.tree);
        let (body, tree_body) = (&exhibit.bodies[index], &tree.bodies[index]);
        let indent = "  ".repeat(depth);
        let frame = parent.map_or(Pose::IDENTITY, |parent| exhibit.bodies[parent].pose);
        let (at, turn) = (frame.inverse_point(body.pose.position), frame.rotation.conjugate() * body.pose.rotation);
        let (at, turn) = (numbers(&at.to_array()), quaternion(turn));
        let _ = writeln!(out, "{indent}<body {} pos=\"{at}\" quat=\"{turn}\">", named(&body.name));
        let (i, center) = (body.properties.inertia, numbers(&body.properties.center.to_array()));
        let inertia = numbers(&[i.x_axis.x, i.y_axis.y, i.z_axis.z, i.x_axis.y, i.x_axis.z, i.y_axis.z]);
        let mass = body.properties.mass;
        let _ = writeln!(out, "{indent}  <inertial pos=\"{center}\" mass=\"{mass}\" fullinertia=\"{inertia}\"/>");
        let point = numbers(&body.pose.inverse_point(tree_body.joint.point).to_array());
        let damping = self.damping(index);
        if !tree_body.joint.names.is_empty() {
            // XML has no two dashes inside a comment.
            let names = tree_body.joint.names.join(", ").replace("--", "- -");
            let _ = writeln!(out, "{indent}  <!-- {names} -->");
        }
        for (k, freedom) in tree_body.joint.freedoms.iter().enumerate() {
            let name = named(&self.joint_name(index, k));
            let axis = |v: &DVec3| numbers(&body.pose.inverse_vector(*v).to_array());
            let range = self.ranges.iter().filter(|r| (r.0, r.1) == (index, k)).map(|r| r.2);
            let range = range.reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])]);
            let limit = range.map_or(String::new(), |[a, b]| format!(" limited=\"true\" range=\"{a} {b}\""));
            let _ = match freedom {
                Freedom::Free => writeln!(out, "{indent}  <freejoint {name}/>"),
                Freedom::Ball => writeln!(out, "{indent}  <joint {name} type=\"ball\" pos=\"{point}\"/>"),
                Freedom::Rotation(v) => {
                    let axis = axis(v);
                    writeln!(
                        out,
                        "{indent}  <joint {name} type=\"hinge\" pos=\"{point}\" axis=\"{axis}\"{damping}{limit}/>"
                    )
                }
                Freedom::Translation(v) => {
                    let axis = axis(v);
                    writeln!(
                        out,
                        "{indent}  <joint {name} type=\"slide\" pos=\"{point}\" axis=\"{axis}\"{damping}{limit}/>"
                    )
                }
            };
            self.start(index, parent, freedom);
        }
        *out += &shapes::geoms(exhibit, Some(index), &format!("{indent}  "), &mut self.meshes);
        for line in self.sites[index + 1].lines() {
            let _ = writeln!(out, "{indent}  {line}");
        }
        for &child in &tree_body.children {
            self.body(child, Some(index), depth + 1, out);
        }
        let _ = writeln!(out, "{indent}</body>");
    }

    /// A body's damping −c m v, −c I ω as that of a joint, where its only joint is one to the world.
    fn damping(&mut self, index: usize) -> String {
        let (body, tree_body) = (&self.exhibit.bodies[index], &self.tree.bodies[index]);
        if body.linear_damping == 0.0 && body.angular_damping == 0.0 {
            return String::new();
        }
        let alone = tree_body.parent.is_none() && tree_body.children.is_empty();
        match tree_body.joint.freedoms.as_slice() {
            [Freedom::Rotation(axis)] if alone => {
                let arm = body.pose.point(body.properties.center) - tree_body.joint.point;
                let own = body.pose.inverse_vector(*axis);
                let c = body.linear_damping * body.properties.mass * axis.cross(arm).length_squared()
                    + body.angular_damping * own.dot(body.properties.inertia * own);
                format!(" damping=\"{c}\"")
            }
            [Freedom::Translation(_)] if alone => {
                format!(" damping=\"{}\"", body.linear_damping * body.properties.mass)
            }
            [] => String::new(),
            _ => {
                self.omit(&body.name, "damping of a body in space; MuJoCo damps joints");
                String::new()
            }
        }
    }

    /// Position and velocity of a degree of freedom at the start.
    fn start(&mut self, index: usize, parent: Option<usize>, freedom: &Freedom) {
        let body = &self.exhibit.bodies[index];
        let about = self.tree.bodies[index].joint.point;
        // Angular velocity, and velocity of the material point at `about`.
        let motion = |body: &soffio_exhibit::Body| {
            let center = body.pose.point(body.properties.center);
            (body.angular_velocity, body.velocity + body.angular_velocity.cross(about - center))
        };
        let (spin, speed) = motion(body);
        let (other_spin, other_speed) = parent.map_or((DVec3::ZERO, DVec3::ZERO), |p| motion(&self.exhibit.bodies[p]));
        match freedom {
            Freedom::Free => {
                let (p, q) = (body.pose.position, body.pose.rotation);
                self.places.extend([p.x, p.y, p.z, q.w, q.x, q.y, q.z]);
                let origin = body.velocity - spin.cross(body.pose.vector(body.properties.center));
                self.velocities.extend(origin.to_array().into_iter().chain(body.pose.inverse_vector(spin).to_array()));
            }
            Freedom::Ball => {
                self.places.extend([1.0, 0.0, 0.0, 0.0]);
                self.velocities.extend(body.pose.inverse_vector(spin - other_spin).to_array());
            }
            Freedom::Rotation(axis) => {
                self.places.push(0.0);
                self.velocities.push(axis.dot(spin - other_spin));
            }
            Freedom::Translation(axis) => {
                self.places.push(0.0);
                self.velocities.push(axis.dot(speed - other_speed));
            }
        }
    }

    /// The start state as a key frame, where anything moves.
    fn key(&self) -> String {
        if self.velocities.iter().all(|v| *v == 0.0) {
            return String::new();
        }
        let (places, speeds) = (numbers(&self.places), numbers(&self.velocities));
        format!("    <key name=\"start\" qpos=\"{places}\" qvel=\"{speeds}\"/>\n")
    }

    /// Reports features of exhibits that MuJoCo models lack.
    fn report_unsupported(&mut self) {
        let exhibit = self.exhibit;
        for drive in &exhibit.drives {
            self.omit(&exhibit.bodies[drive.body].name, "its given motion; it stands still where it starts");
        }
        for constraint in exhibit.constraints.iter().filter(|c| c.friction.is_some()) {
            let why = "friction of its pivot, which grows with the load; MuJoCo's does not";
            self.omit(constraint.group(), why);
        }
        if !exhibit.wind_surfaces.is_empty() || !exhibit.winds.is_empty() {
            self.omit("air", "wind and the air's drag; the model moves in a vacuum");
        }
        if exhibit.colliders.iter().any(|c| exhibit.materials[c.material].restitution > 0.0) {
            self.omit("touches", "restitution; MuJoCo's touches are soft, their friction is taken over");
        }
    }
}

/// Contact pairs: colliders that can touch.
fn pairs(exhibit: &Exhibit) -> String {
    let mut out = String::new();
    for pair in exhibit.collider_pairs().meet {
        let surface = exhibit.surface_pair(pair);
        let [a, b] = [pair.a, pair.b].map(|i| escaped(&format!("geom {i} {}", exhibit.colliders[i].node)));
        let (slide, spin, roll) = (surface.friction, surface.resistance.spinning, surface.resistance.rolling);
        let dimensions = if spin > 0.0 || roll > 0.0 { 6 } else { 3 };
        let friction = numbers(&[slide, slide, spin, roll, roll]);
        let _ =
            writeln!(out, "    <pair geom1=\"{a}\" geom2=\"{b}\" condim=\"{dimensions}\" friction=\"{friction}\"/>");
    }
    out
}

fn named(name: &str) -> String {
    format!("name=\"{}\"", escaped(name))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Numbers separated by spaces, each the shortest that reads back to the same bits.
fn numbers(list: &[f64]) -> String {
    list.iter().map(|x| format!("{}", x + 0.0)).collect::<Vec<_>>().join(" ")
}

/// A quaternion, scalar first.
fn quaternion(q: DQuat) -> String {
    numbers(&[q.w, q.x, q.y, q.z])
}
