//! `soffio explain`: every resolved value of an exhibit, or of a configuration, and where it comes from.

use std::fmt::Write;
use std::path::Path;

use super::failure::{Failure, Outcome};
use super::setup;
use soffio_config::{Config, LoadedConfig};
use soffio_exhibit::diagnostic::{quoted, similar_names};
use soffio_exhibit::{self as exhibit, Exhibit, Origin};
use soffio_multibody::collision::{Collider, PairExclusion};

/// Prints each value of an exhibit, or of a configuration, with its origin.
#[derive(clap::Args, Debug, Default)]
#[command(after_help = "\
Examples:
  soffio explain steel-fish Boom
  soffio explain /etc/soffio/kiosk.toml")]
pub struct Args {
    /// Exhibit id or folder, or a configuration (.toml).
    exhibit: String,
    /// Only this body, with everything that names it.
    body: Option<String>,
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let file = Path::new(&args.exhibit);
    if file.extension().is_some_and(|extension| extension == "toml") && args.body.is_none() {
        let loaded = setup::with_staff_overrides(Config::load(Some(file)).map_err(Failure::input)?);
        print!("{}", explain_config(&loaded));
        return Ok(());
    }
    let folder = exhibit::resolve(&args.exhibit).map_err(Failure::input)?;
    let exhibit = exhibit::load(&folder).map_err(Failure::input)?;
    let text = match &args.body {
        None => explain(&exhibit),
        Some(name) => {
            let names = exhibit.bodies.iter().map(|body| body.name.as_str());
            let Some(body) = exhibit.bodies.iter().position(|body| body.name == *name) else {
                let likely = similar_names(name, names.clone());
                let known: Vec<&str> = if likely.is_empty() { names.collect() } else { likely };
                return Err(Failure::input(format!(
                    "no body \"{name}\" in {}; there are {}",
                    exhibit.id,
                    quoted(&known)
                )));
            };
            explain_body(&exhibit, body)
        }
    };
    print!("{text}");
    Ok(())
}

/// A configuration as text: its values, and whether each is the default, from the file, or set in the staff panel. Secrets are not
/// shown.
pub fn explain_config(loaded: &LoadedConfig) -> String {
    /// Keys whose values are secret.
    const SECRET: [&str; 2] = ["staff.pin", "mqtt.password"];
    // A configuration of plain values always has a form in TOML.
    let table = |config: &Config| toml::Table::try_from(config).unwrap_or_default();
    let (values, defaults) = (table(&loaded.config), table(&Config::default()));
    let mut out = String::new();
    for (name, value) in &values {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "\n[{name}]");
        for (key, value) in value.as_table().into_iter().flatten() {
            let dotted = format!("{name}.{key}");
            let default = defaults.get(name).and_then(|table| table.get(key));
            let source = match (&loaded.staff, &loaded.file) {
                (Some(staff), _) if staff.keys.contains(&dotted) => format!("staff panel: {}", staff.file.display()),
                _ if default == Some(value) => "default".into(),
                (_, Some(file)) => file.display().to_string(),
                (_, None) => "built in".into(),
            };
            let secret = SECRET.contains(&dotted.as_str()) && default != Some(value);
            let value = if secret { "(set)".into() } else { value.to_string() };
            let _ = writeln!(out, "  {key:<28} {value}   [{source}]");
        }
    }
    if let Some(problem) = loaded.staff.as_ref().filter(|staff| staff.problem.is_some()) {
        let _ = writeln!(out, "\n{}", problem.summary());
    }
    out
}

/// The whole exhibit as text.
pub fn explain(exhibit: &Exhibit) -> String {
    let mut out = format!("{} ({})\n", exhibit.id, exhibit.folder.display());
    table(&mut out, exhibit.origins.iter());
    for wire in &exhibit.wires {
        wire_line(&mut out, exhibit, wire);
    }
    for cord in &exhibit.cords {
        let length = cord.length(|body| exhibit.bodies[body].pose);
        // Writing to a string cannot fail.
        let _ = writeln!(out, "\ncord {}\n  {:.1} mm long, ⌀ {:.2} mm", cord.name, 1e3 * length, 2e3 * cord.radius);
    }
    pair_lines(&mut out, exhibit, |_| true);
    out
}

/// One body: its own values, then the joints, wires, colliders, surfaces and sounds that name it.
fn explain_body(exhibit: &Exhibit, body: usize) -> String {
    let name = &exhibit.bodies[body].name;
    let mut of = vec![format!("body {name}")];
    for constraint in exhibit.constraints.iter().filter(|c| c.kind.acts_on(body)) {
        of.extend([constraint.group(), &constraint.name].map(|name| format!("constraint {name}")));
    }
    let limits = exhibit.limits.iter().filter(|l| l.kind.acts_on(body));
    of.extend(limits.flat_map(|l| [format!("constraint {}", l.name), format!("limit {}", l.name)]));
    let springs = exhibit.springs.iter().filter(|s| s.kind.acts_on(body));
    of.extend(springs.map(|s| format!("spring {}", s.name)));
    of.extend(exhibit.colliders.iter().filter(|c| c.body == Some(body)).map(|c| format!("collider {}", c.node)));
    of.extend(exhibit.wind_surfaces.iter().filter(|s| s.body == body).map(|s| format!("wind surface {}", s.node)));
    of.extend(exhibit.sounds.iter().filter(|s| s.body == body).map(|s| format!("sound \"{}\"", s.name)));
    let mut out = String::new();
    let excluded = |origin: &Origin| origin.of == "collision" && origin.value.split(" – ").any(|part| part == name);
    table(&mut out, exhibit.origins.iter().filter(|o| of.contains(&o.of) || excluded(o)));
    for wire in exhibit.wires.iter().filter(|wire| wire.body == Some(body)) {
        wire_line(&mut out, exhibit, wire);
    }
    pair_lines(&mut out, exhibit, |collider| collider.body == Some(body));
    out
}

/// Colliders that never meet one of the chosen ones, and why. Parts of one body and static pairs are left out.
fn pair_lines(out: &mut String, exhibit: &Exhibit, chosen: impl Fn(&Collider) -> bool) {
    let pairs = exhibit.collider_pairs();
    let colliders = |a: usize, b: usize| (&exhibit.colliders[a], &exhibit.colliders[b]);
    let of = |(a, b): (&Collider, &Collider)| chosen(a) || chosen(b);
    let meet = pairs.meet.iter().filter(|pair| of(colliders(pair.a, pair.b))).count();
    let mut left_out: Vec<(String, usize)> = Vec::new();
    for (pair, reason) in &pairs.left_out {
        let (a, b) = colliders(pair.a, pair.b);
        if !of((a, b)) || matches!(reason, PairExclusion::SameBody | PairExclusion::BothStill) {
            continue;
        }
        let line = format!("{} – {}: {reason}", a.node, b.node);
        match left_out.iter_mut().find(|(known, _)| *known == line) {
            Some((_, count)) => *count += 1,
            None => left_out.push((line, 1)),
        }
    }
    let _ = writeln!(out, "\npairs\n  {meet} can meet");
    for (line, count) in left_out {
        let times = if count > 1 { format!(" ({count} pairs)") } else { String::new() };
        let _ = writeln!(out, "  {line}{times}");
    }
}

fn table<'a>(out: &mut String, origins: impl Iterator<Item = &'a Origin>) {
    let mut heading = "";
    for origin in origins {
        if origin.of != heading {
            heading = &origin.of;
            // Writing to a string cannot fail.
            let _ = writeln!(out, "\n{heading}");
        }
        let source = if origin.source.is_empty() { String::new() } else { format!("   [{}]", origin.source) };
        let _ = writeln!(out, "  {:<28} {}{source}", origin.key, origin.value);
    }
}

fn wire_line(out: &mut String, exhibit: &Exhibit, wire: &exhibit::Wire) {
    let length: f64 = wire.points.windows(2).map(|p| p[0].distance(p[1])).sum();
    let carrier = wire.body.map_or("the world", |body| exhibit.bodies[body].name.as_str());
    let material = &exhibit.materials[wire.material].name;
    let (points, diameter) = (wire.points.len(), 2e3 * wire.radius);
    let _ = writeln!(
        out,
        "\nwire {}\n  {carrier}: {points} points, {:.1} mm long, ⌀ {diameter:.2} mm, {material}",
        wire.name,
        length * 1e3
    );
}
