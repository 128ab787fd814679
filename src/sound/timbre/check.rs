//! What a preset must be beyond its shape: ranges, names that exist, limits that real-time sets.

use super::error::TimbreError;
use super::limits::{LONGEST_DELAY, MAX_NODES, MAX_PARTIALS, VERSION};
use super::node::{Delay, Map, Mix, Node, Noise, Oscillator, Texture};
use super::number::Number;
use super::preset::Preset;
use super::read::hint;
use super::source::{Drawn, MaterialOverride, Modal, Source, TablePartial};

/// Most points of a curve: a bound on hostile files, far beyond any curve drawn by hand.
const MOST_POINTS: usize = 64;
/// Points of a texture's line, at most: its grain over its resolution, many grains long.
const FINEST_GRAIN: f64 = 1000.0;

/// What is wrong: the key below the node, and the words.
type Problem = (&'static str, String);

impl Preset {
    pub(super) fn check(&self, name: &str) -> Result<(), TimbreError> {
        let wrong = |key: String, problem: String| Err(TimbreError::new(name, key, problem));
        if self.timbre != VERSION {
            let problem = format!("version {} is not known; this program reads {VERSION}", self.timbre);
            return wrong("timbre".into(), problem);
        }
        if self.name != name {
            return wrong("name".into(), format!("\"{}\" is not the file's name \"{name}\"", self.name));
        }
        if let Some((field, value)) = self.specimen.problem() {
            return wrong(format!("specimen.{field}"), format!("{value} must be above 0 and finite"));
        }
        if self.node.len() > MAX_NODES {
            return wrong("node".into(), format!("{} nodes; the limit is {MAX_NODES}", self.node.len()));
        }
        if let Some((second, _)) = self.node.iter().filter(|(_, node)| is_modal(node)).nth(1) {
            return wrong(format!("node.{second}"), "a timbre has one modal node at most; this is another".into());
        }
        for (key, node) in &self.node {
            for input in node.inputs() {
                if !self.node.contains_key(input) {
                    let hint = hint(input, self.node.keys().map(String::as_str));
                    return wrong(format!("node.{key}.in"), format!("no node \"{input}\"{hint}"));
                }
            }
            for (field, number) in node.numbers() {
                if let Some(problem) = number.problem() {
                    return wrong(format!("node.{key}.{field}"), problem);
                }
            }
            if let Err((field, problem)) = node.check() {
                return wrong(format!("node.{key}.{field}"), problem);
            }
        }
        self.order(name).map(drop)
    }
}

fn is_modal(node: &Node) -> bool {
    matches!(node, Node::Modal(_))
}

fn need(fine: bool, field: &'static str, problem: &str) -> Result<(), Problem> {
    if fine { Ok(()) } else { Err((field, problem.into())) }
}

fn positive(value: f64) -> bool {
    value.is_finite() && value > 0.0
}

fn not_negative(value: f64) -> bool {
    value.is_finite() && value >= 0.0
}

impl Node {
    fn check(&self) -> Result<(), Problem> {
        match self {
            Self::Modal(modal) => modal.check(),
            Self::Noise(Noise { base, octaves, roughness, .. }) => {
                need(positive(*base) && *base <= 1000.0, "base", "must be above 0 and at most 1000 Hz")?;
                need((1..=12).contains(octaves), "octaves", "must be 1 to 12")?;
                need((0.0..=1.0).contains(roughness), "roughness", "must be 0 to 1")
            }
            Self::Texture(Texture { grain, octaves, roughness, resolution, .. }) => {
                need(positive(*grain) && *grain <= 10.0, "grain", "must be above 0 and at most 10 m")?;
                need((1..=12).contains(octaves), "octaves", "must be 1 to 12")?;
                need((0.0..=1.0).contains(roughness), "roughness", "must be 0 to 1")?;
                let fine = positive(*resolution) && (2.0..=FINEST_GRAIN).contains(&(grain / resolution));
                need(fine, "resolution", "must be 1/1000 to 1/2 of the grain, m")
            }
            Self::Oscillator(Oscillator { phase, .. }) => {
                need((0.0..=1.0).contains(phase), "phase", "must be 0 to 1, of a period")
            }
            Self::Function(function) => function.compile().map(drop).map_err(|problem| ("of", problem)),
            Self::Map(Map { points, .. }) => {
                let count = (2..=MOST_POINTS).contains(&points.len());
                need(count, "points", "a curve has 2 to 64 points [in, out]")?;
                let finite = points.iter().flatten().all(|v| v.abs() <= 1e9);
                need(finite, "points", "must be numbers within ±1e9")?;
                need(points.windows(2).all(|p| p[0][0] < p[1][0]), "points", "must ascend in their first number")
            }
            Self::Delay(Delay { time, feedback, .. }) => {
                let fixed = match time {
                    Number::Fixed(time) => (0.0..=LONGEST_DELAY).contains(time),
                    Number::Bound(_) => true,
                };
                need(fixed, "time", "must be 0 to 0.1 s")?;
                need(feedback.abs() <= 0.99, "feedback", "must be −0.99 to 0.99")
            }
            Self::Sum(Mix { r#in, .. }) | Self::Product(Mix { r#in, .. }) => {
                need((1..=MAX_NODES).contains(&r#in.len()), "in", "must name 1 to 16 nodes")
            }
            Self::Filter(_) | Self::Env(_) | Self::Value(_) | Self::Fm(_) => Ok(()),
        }
    }
}

impl Modal {
    fn check(&self) -> Result<(), Problem> {
        need((1..=MAX_PARTIALS).contains(&self.partials), "partials", "must be 1 to 1024")?;
        need(not_negative(self.support_loss), "support_loss", "must be 0 or more, 1/s")?;
        need(positive(self.contact_radius), "contact_radius", "must be above 0, m")?;
        let on_body = |at: f64| (-1.0..=1.0).contains(&at);
        need(self.drive_at.is_none_or(on_body), "drive_at", "must be -1 to 1 along the body")?;
        need(self.surface_modulus.is_none_or(positive), "surface_modulus", "must be above 0, Pa")?;
        need((0.0..=100.0).contains(&self.detune), "detune", "must be 0 to 100 cents")?;
        let length = |value: Option<f64>, field| need(value.is_none_or(positive), field, "must be above 0, m");
        let hang = |value: f64| need((0.0..=1.0).contains(&value), "hang", "must be 0 to 1 of the length");
        match &self.source {
            Source::Plate(plate) => plate.material.check(),
            Source::Mesh(mesh) => mesh.material.check(),
            Source::Table(table) => {
                need(positive(table.fundamental), "fundamental", "must be above 0, Hz")?;
                length(table.radius, "radius")?;
                let count = (1..=MAX_PARTIALS).contains(&table.table.len());
                need(count, "table", "a table has 1 to 1024 partials")?;
                let fine = |p: &TablePartial| positive(p.ratio) && positive(p.t60) && p.gain.is_finite();
                need(table.table.iter().all(fine), "table", "ratios and t60 must be above 0, gains finite")
            }
            Source::Tube(tube) => {
                length(tube.length, "length")?;
                length(tube.outer, "outer")?;
                need(tube.inner.is_none_or(not_negative), "inner", "must be 0 or more, m")?;
                let hollow = tube.inner.is_none_or(|inner| tube.outer.is_none_or(|outer| inner < outer));
                need(hollow, "inner", "must be below outer")?;
                hang(tube.hang)?;
                need((0.0..=200.0).contains(&tube.split), "split", "must be 0 to 200 cents")?;
                need(tube.plane.is_finite(), "plane", "must be an angle, rad")?;
                tube.material.check()
            }
            Source::Bar(bar) => {
                length(bar.length, "length")?;
                length(bar.width, "width")?;
                length(bar.thickness, "thickness")?;
                hang(bar.hang)?;
                bar.material.check()
            }
            Source::String(string) => {
                length(string.length, "length")?;
                need(string.tension.is_none_or(positive), "tension", "must be above 0, N")?;
                need(string.mass.is_none_or(positive), "mass", "must be above 0, kg")?;
                let b = (0.0..=1.0).contains(&string.inharmonicity);
                need(b, "inharmonicity", "must be 0 to 1; a piano's are 1e-4 to 1e-2")?;
                string.material.check()
            }
            Source::MassSpring(spring) => {
                need(positive(spring.stiffness), "stiffness", "must be above 0, N/m")?;
                need(spring.mass.is_none_or(positive), "mass", "must be above 0, kg")?;
                need(positive(spring.t60), "t60", "must be above 0, s")
            }
            Source::Membrane(membrane) => {
                need(positive(membrane.fundamental), "fundamental", "must be above 0, Hz")?;
                need(positive(membrane.radius), "radius", "must be above 0, m")?;
                let high = membrane.high.is_finite() && membrane.high > membrane.fundamental;
                need(high, "high", "must be above the fundamental, Hz")?;
                falling(membrane.t60)?;
                tilted(membrane.tilt)
            }
            Source::Random(drawn) => drawn.check(),
        }
    }
}

fn falling([first, last]: [f64; 2]) -> Result<(), Problem> {
    need(positive(first) && positive(last) && last <= first, "t60", "must be [at low, at high], falling, s")
}

fn tilted(tilt: f64) -> Result<(), Problem> {
    need(tilt.abs() <= 60.0, "tilt", "must be −60 to 60 dB per octave")
}

impl Drawn {
    fn check(&self) -> Result<(), Problem> {
        need(positive(self.low), "low", "must be above 0, Hz")?;
        need(self.high.is_finite() && self.high > self.low, "high", "must be above low, Hz")?;
        need(self.radius.is_none_or(positive), "radius", "must be above 0, m")?;
        falling(self.t60)?;
        need((1.0..=10.0).contains(&self.t60_spread), "t60_spread", "must be 1 to 10")?;
        tilted(self.tilt)
    }
}

impl MaterialOverride {
    fn check(&self) -> Result<(), Problem> {
        let numbers = [self.youngs_modulus, self.shear_modulus, self.density, self.loss_factor];
        need(numbers.into_iter().flatten().all(positive), "material", "its numbers must be above 0")?;
        let poisson = self.poisson.is_none_or(|nu| nu > -1.0 && nu <= 0.5);
        need(poisson, "material.poisson", "must be above −1 and at most 0.5")
    }
}
