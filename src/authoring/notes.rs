//! Wind chimes tuned to given notes: tube lengths and sidecar.

use std::fmt::Write;

use super::chimes::{self, ChimeDesign};
use super::stock_parts::MM;
use super::texts::{AttractBreath, attract, in_three_languages, labels};
use super::{ExhibitFolder, starter};
use soffio_exhibit::codes;
use soffio_exhibit::diagnostic::Diagnostic;
use soffio_math::{PI, exp, ln};
use soffio_sound::modes::{Section, beam_modes};

/// Fewest and most tubes: fewer do not touch the striker, more do not fit around it.
pub const COUNT: [usize; 2] = [3, 8];
/// Lowest and highest note, Hz: C4 and C7.
const FREQUENCY_RANGE: [f64; 2] = [261.0, 2100.0];
/// Concert pitch A4, Hz.
const CONCERT_PITCH: f64 = 440.0;

/// A note by its name: C5, F#4, Bb5.
#[derive(Clone, Debug)]
pub struct Note {
    /// The name as it was written.
    pub name: String,
    /// Frequency in equal temperament, Hz.
    pub frequency: f64,
}

/// Parses a note.
///
/// # Errors
/// Where the text is not a note, or the note is out of range.
pub fn note(text: &str) -> Result<Note, Diagnostic> {
    let name = text.trim();
    let wrong = |why: &str| {
        Diagnostic::new(codes::NEW, format!("\"{name}\" is not a note for a tube{why}"))
            .help("write C5, F#4 or Bb5, from C4 to C7")
    };
    let mut rest = name.chars();
    let letter = rest.next().ok_or_else(|| wrong(""))?;
    let step = match letter.to_ascii_uppercase() {
        'C' => 0,
        'D' => 2,
        'E' => 4,
        'F' => 5,
        'G' => 7,
        'A' => 9,
        'B' => 11,
        _ => return Err(wrong("")),
    };
    let rest = rest.as_str();
    let (shift, octave) = match rest.strip_prefix(['#', '♯']) {
        Some(octave) => (1, octave),
        None => rest.strip_prefix(['b', '♭']).map_or((0, rest), |octave| (-1, octave)),
    };
    let octave: i32 = octave.parse().ok().filter(|o| (0..=9).contains(o)).ok_or_else(|| wrong(""))?;
    let semitones = f64::from(step + shift + 12 * (octave - 4) - 9);
    let frequency = CONCERT_PITCH * exp(ln(2.0) * semitones / 12.0);
    if !(FREQUENCY_RANGE[0]..=FREQUENCY_RANGE[1]).contains(&frequency) {
        return Err(wrong(": it is too low or too high"));
    }
    Ok(Note { name: name.to_owned(), frequency })
}

/// Length (m) of a tube of 6061-T6 aluminium whose first bending mode has this frequency (Hz).
pub fn length(frequency: f64) -> f64 {
    let [outer, wall] = chimes::ALUMINIUM.stocks[0].size.map(|mm| mm * MM);
    let inner = outer - 2.0 * wall;
    let (youngs_modulus, poisson, density) = (68.9e9, 0.33, chimes::ALUMINIUM.stocks[0].density);
    // Cowper's shear coefficient of a tube.
    let m = (inner / outer) * (inner / outer);
    let whole = (1.0 + m) * (1.0 + m);
    let shear = 6.0 * (1.0 + poisson) * whole / ((7.0 + 6.0 * poisson) * whole + (20.0 + 12.0 * poisson) * m);
    let pitch = |length: f64| {
        let section = Section {
            length,
            area: 0.25 * PI * (outer * outer - inner * inner),
            gyration: 0.25 * (outer * outer + inner * inner).sqrt(),
            youngs_modulus,
            shear_stiffness: shear * youngs_modulus / (2.0 * (1.0 + poisson)),
            density,
        };
        beam_modes(&section, 1).first().map_or(0.0, |mode| mode.frequency)
    };
    // Half the length is nearly two octaves higher, so bisection converges.
    let (mut short, mut long) = (0.1, 1.5);
    for _ in 0..50 {
        let middle = 0.5 * (short + long);
        if pitch(middle) > frequency { short = middle } else { long = middle }
    }
    0.5 * (short + long)
}

/// Wind chimes with these notes.
///
/// # Errors
/// Where there are too few or too many notes.
pub fn chime(id: &str, notes: &[Note]) -> Result<ExhibitFolder, Diagnostic> {
    let [fewest, most] = COUNT;
    if !(fewest..=most).contains(&notes.len()) {
        let message = format!("{} tubes: too few or too many for a chime", notes.len());
        return Err(Diagnostic::new(codes::NEW, message).help(format!("give {fewest} to {most} notes")));
    }
    let mut sorted: Vec<&Note> = notes.iter().collect();
    sorted.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    // A saw is precise to a tenth of a millimetre.
    let lengths: Vec<f64> = sorted.iter().map(|note| (length(note.frequency) / MM * 10.0).round() / 10.0).collect();
    let design = ChimeDesign { title: id, lengths: &lengths, ..chimes::ALUMINIUM };
    let shipped = include_str!("../../exhibits/wind-chimes/exhibit.toml");
    let mut out = starter::header(id, "Wind chimes: aluminium tubes around a wooden disc that a sail moves.");
    // Materials of the shipped chimes.
    let between = |from: &str, to: &str| {
        let start = shipped.find(from).unwrap_or_default();
        &shipped[start..start + shipped[start..].find(to).unwrap_or_default()]
    };
    out.push('\n');
    out.push_str(between("# ---- what things are made of", "# ---- bodies"));
    bodies(&mut out, lengths.len());
    let cord = "radius = \"0.7 mm\"\nmaterial = \"nylon\"\ncolor = [0.55, 0.47, 0.34]\nmetallic = 0.0\nroughness = 0.8\nwind = false\n";
    out.push_str(between("# ---- wires", "[[wire]]\nname = \"cord-1\""));
    let cords = (1..=lengths.len()).map(|k| (format!("cord-{k}"), format!("Cord{k}"), format!("CordLine{k}")));
    let lines = [("striker-line", "Striker", "StrikerLine"), ("sail-line", "Sail", "SailLine")];
    for (name, body, line) in cords.chain(lines.map(|(a, b, c)| (a.into(), b.into(), c.into()))) {
        let _ = write!(out, "[[wire]]\nname = \"{name}\"\nbody = \"{body}\"\npoints = \"{line}.*\"\n{cord}\n");
    }
    out.push_str(between("# ---- joints", "[[constraint.point-to-point]]\nname = \"cord-1\""));
    let friction = "friction = { coefficient = 0.25, radius = \"0.5 mm\" }\n\n";
    for k in 1..=lengths.len() {
        let _ = write!(
            out,
            "[[constraint.point-to-point]]\nname = \"cord-{k}\"\na = {{ node = \"Cord{k}\" }}\n\
             b = {{ node = \"Crown\", at = \"CrownHole{k}\" }}\n{friction}\
             [[constraint.point-to-point]]\nname = \"pin-{k}\"\na = {{ node = \"Tube{k}\", at = \"Pin{k}\" }}\n\
             b = {{ node = \"Cord{k}\", at = \"CordEnd{k}\" }}\n{friction}"
        );
    }
    out.push_str(between("[[constraint.point-to-point]]\nname = \"striker-on-crown\"", "[[collider]]"));
    let radius = 0.5 * design.stocks[0].size[0];
    for (k, length) in (1..).zip(&lengths) {
        // The caps of a capsule are round: its straight part ends a radius before the tube does.
        let height = ((length - 2.0 * radius) * 10.0).round() / 10.0;
        let shape = format!("{{ capsule = {{ height = \"{height} mm\", radius = \"{radius} mm\" }} }}");
        let _ = write!(out, "[[collider]]\nnode = \"Pipe{k}\"\nshape = {shape}\n\n");
    }
    out.push_str(between("[[collider]]\nnode = \"StrikerDisc\"", "[[sound]]"));
    for ((k, length), note) in (1..).zip(&lengths).zip(&sorted) {
        let half = (length * 50.0).round() / 100.0;
        let _ = write!(
            out,
            "# {}, {:.1} Hz\n[[sound]]\nname = \"tube-{k}\"\nbody = \"Tube{k}\"\non = \"impact\"\n\
             timbre = \"chime-aluminium\"\nparams = {{ half_length = \"{half} mm\", half_width = \"{radius} mm\" }}\ncaption = \"tube\"\n\n",
            note.name, note.frequency
        );
    }
    out.push_str(between("[[sound]]\nname = \"air\"", "# ---- when nobody"));
    out.push_str(&attract(&[
        AttractBreath { at: 5.0, strength: 0.35, aim: [0.5, 0.86] },
        AttractBreath { at: 26.0, strength: 0.5, aim: [0.5, 0.86] },
    ]));
    out.push('\n');
    out.push_str(&labels(&chime_texts(lengths.len())));
    let remarks = (sorted.iter().zip(&lengths))
        .map(|(note, length)| format!("{}: {:.1} Hz, a tube of {length:.1} mm", note.name, note.frequency))
        .collect();
    let files = ExhibitFolder::files_of(id, out, chimes::glb(&design));
    Ok(ExhibitFolder { files, remarks })
}

fn bodies(out: &mut String, count: usize) {
    out.push_str("# ---- bodies --------------------------------------------------------------------------------------------------\n\n");
    let tubes = (1..=count).map(|k| (format!("Tube{k}"), "aluminium"));
    let cords = (1..=count).map(|k| (format!("Cord{k}"), "hardwood"));
    let crown = [("Crown".to_owned(), "hardwood")];
    let below = [("Striker".to_owned(), "hardwood"), ("Sail".to_owned(), "lime")];
    for (node, material) in crown.into_iter().chain(cords).chain(tubes).chain(below) {
        let _ = write!(out, "[[body]]\nnode = \"{node}\"\nmaterial = \"{material}\"\n\n");
    }
}

fn chime_texts(count: usize) -> Vec<super::texts::LabelTexts> {
    in_three_languages(
        ["Wind chimes (replace this title)", "풍경 (제목을 바꾸세요)", "Campane a vento (titolo da sostituire)"],
        [
            "Each tube hangs by a pin at 22.4 percent of its length, where its lowest mode of bending is at rest: so it rings long.",
            "관은 저마다 길이의 22.4퍼센트 자리에 꽂은 핀에 매달려 있다. 가장 낮은 휨 진동이 거기서 멈춰 있으므로 오래 울린다.",
            "Ogni tubo pende da un perno al 22,4 per cento della sua lunghezza, dove il suo modo di flessione più basso sta fermo: \
             così risuona a lungo.",
        ],
        [
            format!(
                "From a round wooden board {count} metal tubes of different lengths hang in a circle about a wooden disc; below it a red sail."
            ),
            format!(
                "둥근 나무판에서 길이가 다른 금속관 {count}개가 나무 원판을 둘러싸고 매달려 있고, 그 아래 빨간 돛이 있다."
            ),
            format!(
                "Da una tavola rotonda pendono in cerchio {count} tubi di metallo di lunghezze diverse attorno a un disco di legno; sotto, una vela rossa."
            ),
        ],
        &[
            ("tube", ["[aluminium tube rings]", "[알루미늄 관 울리는 소리]", "[un tubo d'alluminio risuona]"]),
            ("wind", ["[breath rushes past]", "[숨결이 스치는 소리]", "[fruscio del soffio]"]),
        ],
    )
}
