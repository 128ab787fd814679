//! Sidecars of new exhibits with explanatory comments: a mobile of given plates, and a single disc.

use std::fmt::Write;

use super::ExhibitFolder;
use super::glb::{Finish, Scene};
use super::hanging::{SheetStock, disc};
use super::mobile::Mobile;
use super::piece::Piece;
use super::plate_mobile::{Metal, Outline, PlacedPlate, PlateMobile, mobile as plate_mobile};
use super::stock_parts::{ALUMINIUM, MM, ceiling, write};
use super::texts::{AttractBreath, LabelTexts, attract, in_three_languages, labels};
use soffio_exhibit::diagnostic::Diagnostic;
use soffio_math::DVec3;

/// Heading of a section of the sidecar.
fn section_heading(title: &str) -> String {
    format!("\n# ---- {title} {}\n", "-".repeat(106_usize.saturating_sub(title.chars().count())))
}

/// `LargeStem` as a sidecar name: `large-stem`.
fn kebab(name: &str) -> String {
    let mut out = String::new();
    for c in name.chars() {
        if c.is_ascii_uppercase() && !out.is_empty() {
            out.push('-');
        }
        out.push(c.to_ascii_lowercase());
    }
    out
}

/// Beginning of every new sidecar.
pub(super) fn header(id: &str, about: &str) -> String {
    format!(
        "# {about}\n\
         # `soffio check` with this folder says what is wrong in this file, where, and what to do; `soffio explain` prints each\n\
         # value with its origin; `soffio schema exhibit` lists every key. Numbers are SI (m, kg, s); a text\n\
         # may carry a unit: \"12 mm\", \"35 deg\", \"85 g\".\n\
         schema = \"exhibit/1\"\nmodel = \"{id}.glb\"\nid = \"{id}\"\n\n\
         [scene]\ncamera = \"CamFront\"\n\
         # Level of all sounds: `soffio loudness --write` makes exhibits equally loud.\nlevel = \"0 dB\"\n"
    )
}

/// The wire tables of a piece; fixed ones have no `body`.
fn wires(out: &mut String, piece: &Piece, still: bool) {
    for bend in &piece.wires {
        let _ = write!(out, "\n[[wire]]\nname = \"{}\"\n", kebab(bend.name));
        if !still {
            let _ = writeln!(out, "body = \"{}\"", piece.name);
        }
        let radius = (bend.radius / MM * 1e4).round() / 1e4;
        let _ = write!(out, "points = \"{}.*\"\nradius = \"{radius} mm\"\nmaterial = \"steel\"\n", bend.name);
        if still {
            out.push_str("color = [0.05, 0.05, 0.055]\nmetallic = 0.9\nroughness = 0.45\n");
        }
    }
}

/// The joint tables of a mobile whose pieces hang by their first markers, the first at the fixed node `point`.
fn joints(out: &mut String, mobile: &Mobile, point: &str) {
    let friction = "friction = { coefficient = 0.3, radius = \"0.3 mm\" }\n";
    for (i, (piece, pose)) in mobile.pieces.iter().enumerate() {
        let (name, hook) = (kebab(piece.name), piece.markers[0].0);
        let carrier = mobile.pieces[..i].iter().find_map(|(above, place)| {
            let (marker, _) = above.markers.iter().skip(1).find(|(_, p)| place.point(*p) == pose.position)?;
            Some((above.name, *marker))
        });
        let _ = match carrier {
            None => write!(
                out,
                "\n[[constraint.nail]]\nname = \"{name}-hangs\"\nbody = \"{}\"\nat = \"{hook}\"\nto = {{ node = \"{point}\" }}\n{friction}",
                piece.name
            ),
            Some((above, marker)) => write!(
                out,
                "\n[[constraint.point-to-point]]\nname = \"{name}-on-{}\"\na = {{ node = \"{}\", at = \"{hook}\" }}\n\
                 b = {{ node = \"{above}\", at = \"{marker}\" }}\n{friction}",
                kebab(above),
                piece.name
            ),
        };
    }
}

/// Idle damping of a mobile.
const CALM: &str = "# Idle damping brings the mobile to rest, so that the next visitor sees the effect of their own breath.\n\
                    [wind.idle_damping]\nafter = \"3 s\"\ntime = \"2.5 s\"\n\n";

/// Collider, wind surface and sound of a plate.
fn plates(out: &mut String, names: &[&str]) {
    for name in names {
        let _ = write!(out, "\n[[collider]]\nnode = \"{name}\"\nshape = {{ fit = \"plate\" }}\n");
    }
    for (seed, name) in (1..).zip(names) {
        let _ = write!(
            out,
            "\n[[wind_surface]]\nnode = \"{name}\"\nsampling = {{ per_area = \"9000 /m2\", min = 16, max = 32, seed = {seed} }}\n"
        );
    }
    out.push_str(&section_heading("sound"));
    out.push_str("# A plate's size, shape and material make its notes; `soffio sound --list` names the timbres.\n");
    for name in names {
        let _ = write!(
            out,
            "\n[[sound]]\nname = \"{}-rings\"\nbody = \"{name}\"\non = \"impact\"\ntimbre = \"plate\"\ncaption = \"plate\"\n",
            kebab(name)
        );
    }
    let _ = write!(
        out,
        "\n[[sound]]\nname = \"air\"\nbody = \"{}\"\non = \"wind\"\ntimbre = \"wind-room\"\ncaption = \"wind\"\n\n",
        names.first().copied().unwrap_or_default()
    );
}

/// Captions of plates in English, Korean, Italian.
const CAPTIONS: [(&str, [&str; 3]); 2] = [
    ("plate", ["[metal plate rings]", "[금속판 울리는 소리]", "[una piastra di metallo risuona]"]),
    ("wind", ["[breath rushes past]", "[숨결이 스치는 소리]", "[fruscio del soffio]"]),
];

/// A balanced mobile of `outlines`, cut from sheet of `thickness` m.
///
/// # Errors
/// All plates that cannot be cut or paired.
pub fn mobile(id: &str, outlines: &[Outline], thickness: f64, metal: Metal) -> Result<ExhibitFolder, Vec<Diagnostic>> {
    let given = plate_mobile(id, outlines, thickness, metal)?;
    let mobile = &given.mobile;
    let about = format!(
        "A mobile of {} plates that ring in pairs. `soffio new` has bent its wires so that it hangs level. A change of a\n\
         # plate destroys the balance: create the mobile again instead.\n#",
        given.plates.len()
    );
    let mut out = header(id, &about);
    out.push_str(&section_heading("what things are made of"));
    let _ = write!(
        out,
        "# Density, friction and sound follow from a material's name; keys here change it. Sheet on a hook rings\n\
         # shorter than the bare metal: the loss factor says how fast a sound fades.\n\n[material.{}]\nloss_factor = 2e-3\n",
        metal.name()
    );
    out.push_str(&section_heading("bodies"));
    out.push_str(
        "# Each moves as one with the nodes below it in the model. Its mass is its volume times the density.\n",
    );
    for (piece, _) in &mobile.pieces {
        let plate = given.plates.iter().find(|plate| plate.node == piece.name);
        let material = plate.map_or("steel", |_| metal.name());
        let note = plate.map_or(String::new(), |plate| format!("# {}\n", plate.source));
        let _ = write!(out, "\n{note}[[body]]\nnode = \"{}\"\nmaterial = \"{material}\"\n", piece.name);
    }
    out.push_str(&section_heading("wires"));
    out.push_str("# Drawn through the model's nodes whose names begin so. They have mass and feel the wind.\n");
    wires(&mut out, &mobile.stand, true);
    mobile.pieces.iter().for_each(|(piece, _)| wires(&mut out, piece, false));
    out.push_str(&section_heading("joints"));
    out.push_str("# Loops in loops: two points that coincide. Their friction brings a rotating piece to rest.\n");
    joints(&mut out, mobile, "CeilingPoint");
    out.push_str(&section_heading("collisions, wind and sound"));
    let names: Vec<&str> = given.plates.iter().map(|plate| plate.node).collect();
    plates(&mut out, &names);
    let gain = metal.gain(thickness);
    if gain > 1.0 {
        let _ = write!(
            out,
            "# A breath hardly moves such heavy sheet: this multiplies its force.\n[wind.breath]\ngain = {gain:?}\n\n"
        );
    }
    out.push_str(CALM);
    out.push_str(&attract(&attract_breaths(&given)));
    out.push('\n');
    out.push_str(&labels(&mobile_words(given.plates.len())));
    let s = mobile.statics();
    let mut remarks: Vec<String> = (given.plates.iter())
        .map(|PlacedPlate { node, source, .. }| {
            let piece = mobile.pieces.iter().find(|(piece, _)| piece.name == *node);
            let grams = piece.map_or(0.0, |(piece, _)| 1e3 * piece.mass().mass);
            format!("{node}: {source}, {grams:.1} g with its stem")
        })
        .collect();
    let (grams, tilt) = (1e3 * s.total_mass, s.tilt_period);
    remarks.push(format!("in all {grams:.1} g; it tilts to and fro in {tilt:.1} s; level to {:.0e} m", s.worst_offset));
    Ok(ExhibitFolder { files: ExhibitFolder::files_of(id, out, given.glb), remarks })
}

/// Breaths at the front plate of each pair, gentle ones first, at most four.
fn attract_breaths(given: &PlateMobile) -> Vec<AttractBreath> {
    let front = given.pairs.iter().take(4).map(|[_, front]| given.plates[*front].picture_position);
    let breath = |(i, aim)| AttractBreath { at: 5.0 + 18.0 * i as f64, strength: 0.35 + 0.1 * i as f64, aim };
    front.enumerate().map(breath).collect()
}

fn mobile_words(count: usize) -> Vec<LabelTexts> {
    in_three_languages(
        ["Mobile (replace this title)", "모빌 (제목을 바꾸세요)", "Mobile (titolo da sostituire)"],
        [
            "Its plates hang from bent wires, each hooked where it balances. Two and two they hang close: a breath makes \
             them meet and ring, the larger the lower.",
            "판은 휜 철사에, 저마다 균형을 이루는 자리에 걸려 있다. 둘씩 가까이 있어 숨결에 부딪혀 울리며, 클수록 낮은 소리가 난다.",
            "Le piastre pendono da fili piegati, ciascuno agganciato dove sta in equilibrio. A due a due sono vicine: un \
             soffio le fa incontrare e risuonare, tanto più grave quanto più sono grandi.",
        ],
        [
            format!("A mobile: {count} flat metal plates hang from bent wires, in pairs one close before the other."),
            format!("납작한 금속판 {count}개가 휜 철사에, 둘씩 앞뒤로 가까이 매달린 모빌."),
            format!(
                "Un mobile: {count} piastre piatte di metallo pendono da fili piegati, a coppie una davanti all'altra."
            ),
        ],
        &CAPTIONS,
    )
}

/// One disc on a stem: the simplest exhibit that swings in a breath.
pub fn empty(id: &str) -> ExhibitFolder {
    let mut scene = Scene::default();
    let red = scene.finish(&Finish {
        name: "Red paint",
        color: [0.55, 0.018, 0.012],
        metallic: 0.0,
        roughness: 0.40,
        finish: Some("paint"),
    });
    let iron = scene.finish(&Finish {
        name: "Dark iron",
        color: [0.05, 0.05, 0.055],
        metallic: 0.9,
        roughness: 0.45,
        finish: Some("iron-cast"),
    });
    let hook = 0.45 * DVec3::Y;
    let stock = SheetStock { thickness: 1.0 * MM, density: ALUMINIUM, finish: red };
    let disc = disc(["Disc", "DiscHook", "DiscStem"], 120.0 * MM, 90.0 * MM, stock);
    let target = hook - 0.08 * DVec3::Y;
    let stand = ceiling(iron);
    let mut out = header(id, "One disc on a hook: the simplest exhibit. Add your own bodies.");
    out.push_str(&section_heading("bodies"));
    out.push_str(
        "# A body is a node of the model (Blender: an object) that moves as one with the nodes below it. A node that is\n\
         # no body is fixed. `soffio import your-model.glb` writes such a file for your own model.\n\n\
         [[body]]\nnode = \"Disc\"\nmaterial = \"aluminium\"\n",
    );
    out.push_str(&section_heading("wires"));
    out.push_str("# Drawn through the model's nodes whose names begin so.\n");
    wires(&mut out, &stand, true);
    wires(&mut out, &disc, false);
    out.push_str(&section_heading("joints"));
    out.push_str(
        "# A nail holds a point of a body at a fixed node. Other kinds: hinge, point-to-point, spring, gear, …;\n\
         # `soffio schema exhibit` lists all.\n",
    );
    let mobile =
        Mobile { pieces: vec![(disc.clone(), soffio_math::Pose { position: hook, ..Default::default() })], stand };
    joints(&mut out, &mobile, "CeilingPoint");
    out.push_str(&section_heading("collisions, wind and sound"));
    plates(&mut out, &["Disc"]);
    out.push_str(&attract(&[AttractBreath { at: 5.0, strength: 0.35, aim: [0.5, 0.6] }]));
    out.push('\n');
    let words = in_three_languages(
        ["A disc (replace this title)", "원판 (제목을 바꾸세요)", "Un disco (titolo da sostituire)"],
        [
            "A disc of sheet metal hangs from a hook and swings in a breath.",
            "금속판 원반 하나가 고리에 걸려 숨결에 흔들린다.",
            "Un disco di lamiera pende da un gancio e oscilla in un soffio.",
        ],
        [
            "A round red plate hangs on a wire below a hook.".into(),
            "고리 아래 철사에 빨간 원판이 매달려 있다.".into(),
            "Una piastra rossa rotonda pende da un filo sotto un gancio.".into(),
        ],
        &CAPTIONS,
    );
    out.push_str(&labels(&words));
    let pieces = [(mobile.stand, hook), (disc, hook)];
    let away = DVec3::new(-0.12, 0.05, 1.0).normalize();
    let glb = write(scene, id, &pieces, target + 0.75 * away, target);
    ExhibitFolder { files: ExhibitFolder::files_of(id, out, glb), remarks: Vec::new() }
}
