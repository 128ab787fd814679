//! Plate outlines from an SVG drawing: each filled shape is one plate.
//!
//! A drawing with a physical size (`width="200mm"` and a `viewBox`) is in millimetres. With a size in pixels there are
//! 96 to the inch, as the standard says. Without a size a unit is a millimetre. Curves become polygons within 0.05 mm.
//! Other content (holes, open lines, text, pictures) is refused with its location, all at once.

use std::sync::Arc;

use kurbo::{Affine, BezPath, PathEl, Shape};
use roxmltree::{Document, Node, ParsingOptions};
use svgtypes::{Length, LengthUnit, PointsParser, ViewBox};

use super::outline::area_and_centroid;
use super::plate_mobile::Outline;
use soffio_exhibit::codes;
use soffio_exhibit::diagnostic::{Diagnostic, Location, Report};
use soffio_math::DVec2;

/// Largest distance of a polygon from its curve, mm; nearer corners are merged.
const FLATNESS: f64 = 0.05;
/// Most corners of a plate.
const MAX_CORNERS: usize = 2000;
/// Most plates of a drawing, far more than hang on a mobile.
const MAX_PLATES: usize = 256;
/// Most elements of a drawing, whatever they are.
const MAX_ELEMENTS: u32 = 100_000;
/// Most groups within each other.
const MAX_NESTING: usize = 64;
/// Most segments of a path: with more, it has more corners than a plate may have.
const MAX_SEGMENTS: usize = 4 * MAX_CORNERS;
/// Greatest number in a drawing. Beyond it, arcs become lists of segments that no memory holds.
const MAX_NUMBER: f64 = 1e6;
/// Greatest distance of a point from the origin, mm: no sheet is 10 m long.
const MAX_REACH: f64 = 10_000.0;
/// Most problems that are listed; the rest are counted.
const MAX_PROBLEMS: usize = 20;
/// Length of an inch and of a CSS pixel, mm.
const INCH: f64 = 25.4;
const PIXEL: f64 = INCH / 96.0;

/// Container elements, and elements without a shape.
const GROUPS: [&str; 4] = ["svg", "g", "a", "switch"];
const IGNORED: [&str; 11] = [
    "defs",
    "title",
    "desc",
    "metadata",
    "style",
    "clipPath",
    "mask",
    "marker",
    "symbol",
    "linearGradient",
    "radialGradient",
];

/// The plates of a drawing, in its order; `file` is its name in messages.
///
/// # Errors
/// All problems of the drawing, each with its line.
pub fn outlines(file: &str, text: &str) -> Result<Vec<Outline>, Report> {
    let mut reader = Reader { file, text, plates: Vec::new(), problems: Vec::new(), more: 0 };
    // Asked first, because the parser calls itself for each level.
    if let Some(start) = nested_too_deeply(text) {
        let message = format!("more than {MAX_NESTING} elements within each other");
        reader.report(start..start + 1, message, "ungroup the drawing (Inkscape: Object, Ungroup)");
        return Err(Report::in_file(file, Arc::from(text), reader.problems));
    }
    let options = ParsingOptions { nodes_limit: MAX_ELEMENTS, ..ParsingOptions::default() };
    match Document::parse_with_options(text, options) {
        Ok(document) => reader.root(&document),
        Err(roxmltree::Error::NodesLimitReached) => {
            let message = format!("the drawing has more than {MAX_ELEMENTS} elements");
            reader.report(0..1, message, "keep only the outlines of the plates");
        }
        Err(error) => {
            let at = error.pos();
            let start = offset(text, at.row as usize, at.col as usize);
            let length = text[start..].chars().next().map_or(0, char::len_utf8);
            reader.report(start..start + length, format!("this is not SVG: {error}"), "save the drawing as plain SVG");
        }
    }
    if reader.more > 0 {
        let message = format!("and {} more problems", reader.more);
        reader.problems.push(Diagnostic::new(codes::NEW, message).help("mend those above first"));
    }
    if reader.problems.is_empty() && reader.plates.is_empty() {
        reader.report(0..1, "the drawing has no closed shape".into(), "draw each plate as one closed path");
    }
    match reader.problems.is_empty() {
        true => Ok(reader.plates),
        false => Err(Report::in_file(file, Arc::from(text), reader.problems)),
    }
}

/// Byte offset of a line and column (in characters), both from 1.
fn offset(text: &str, row: usize, column: usize) -> usize {
    let start: usize = text.split_inclusive('\n').take(row.saturating_sub(1)).map(str::len).sum();
    let line = text.get(start..).unwrap_or_default();
    let into: usize = line.chars().take(column.saturating_sub(1)).map(char::len_utf8).sum();
    // The end of a text has no character of its own.
    text.floor_char_boundary((start + into).min(text.len().saturating_sub(1)))
}

/// Byte of the first tag that is nested too deeply.
fn nested_too_deeply(text: &str) -> Option<usize> {
    let (mut depth, mut at) = (0_usize, 0);
    while let Some(start) = text[at..].find('<').map(|found| at + found) {
        let tag = &text[start..];
        // What is not a tag may contain anything.
        let skipped = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
        let other = skipped.into_iter().find(|(begin, _)| tag.starts_with(begin));
        if let Some((begin, end)) = other {
            at = start + begin.len() + tag[begin.len()..].find(end)? + end.len();
            continue;
        }
        let mut quote = None;
        let end = tag.char_indices().find(|&(_, c)| {
            match quote {
                Some(open) if c == open => quote = None,
                None if matches!(c, '"' | '\'') => quote = Some(c),
                _ => {}
            }
            c == '>' && quote.is_none()
        });
        let (end, _) = end?;
        if tag.starts_with("</") {
            depth = depth.saturating_sub(1);
        } else if !tag[..end].ends_with('/') {
            depth += 1;
        }
        if depth > MAX_NESTING {
            return Some(start);
        }
        at = start + end + 1;
    }
    None
}

struct Reader<'a> {
    file: &'a str,
    text: &'a str,
    plates: Vec<Outline>,
    problems: Vec<Diagnostic>,
    /// Problems beyond those that are listed.
    more: usize,
}

impl Reader<'_> {
    fn report(&mut self, span: std::ops::Range<usize>, message: String, help: &str) {
        if self.problems.len() >= MAX_PROBLEMS {
            self.more += 1;
            return;
        }
        let before = &self.text[..span.start.min(self.text.len())];
        let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
        let line = before.matches('\n').count() + 1;
        let mut problem = Diagnostic::new(codes::NEW, message).help(help);
        problem.location = Some(Location { file: self.file.to_owned(), line, column, span });
        self.problems.push(problem);
    }

    /// Reports a problem of an element, at its opening tag.
    fn refuse(&mut self, node: Node, what: &str, help: &str) {
        let all = node.range();
        let head = self.text[all.clone()].find(['>', '\n']).map_or(all.end, |i| all.start + i + 1);
        self.report(all.start..head, format!("{} {what}", element_name(node)), help);
    }

    fn root(&mut self, document: &Document) {
        let root = document.root_element();
        if root.tag_name().name() != "svg" {
            return self.refuse(root, "is not a drawing", "the outermost element of an SVG file is <svg>");
        }
        let view = root.attribute("viewBox").and_then(|text| text.parse::<ViewBox>().ok());
        let width = root.attribute("width").and_then(|text| text.parse::<Length>().ok());
        let size = width.and_then(|width| Some(width.number * millimetres(width.unit)?));
        let scale = match (size, view) {
            (Some(size), Some(view)) if size > 0.0 && view.w > 0.0 => size / view.w,
            (Some(_), None) => PIXEL,
            _ => 1.0,
        };
        // y upwards.
        self.walk(root, Affine::scale_non_uniform(scale, -scale));
    }

    fn walk(&mut self, group: Node, outer: Affine) {
        for node in group.children().filter(Node::is_element) {
            let name = node.tag_name().name();
            let foreign = node.tag_name().namespace().is_some_and(|space| !space.ends_with("/svg"));
            if foreign || IGNORED.contains(&name) || node.attribute("display") == Some("none") {
                continue;
            }
            let own = match node.attribute("transform").map(str::parse::<svgtypes::Transform>) {
                None => Affine::IDENTITY,
                Some(Ok(t)) => Affine::new([t.a, t.b, t.c, t.d, t.e, t.f]),
                Some(Err(error)) => {
                    self.refuse(node, &format!("has a transform that cannot be read: {error}"), "save it as plain SVG");
                    continue;
                }
            };
            let here = outer * own;
            if GROUPS.contains(&name) {
                self.walk(node, here);
                continue;
            }
            match shape(node) {
                Ok(path) => self.plate(node, here * path),
                Err((what, help)) => self.refuse(node, &what, help),
            }
        }
    }

    /// Converts one element to one plate.
    fn plate(&mut self, node: Node, path: BezPath) {
        if self.plates.len() >= MAX_PLATES {
            let what = format!("is one more than {MAX_PLATES} plates");
            return self.refuse(node, &what, "draw fewer, or make several exhibits");
        }
        let far = |p: kurbo::Point| !(p.x.abs() <= MAX_REACH && p.y.abs() <= MAX_REACH);
        if path.elements().len() > MAX_SEGMENTS || path.elements().iter().flat_map(points_of).any(far) {
            let what = format!("has more than {MAX_SEGMENTS} segments, or reaches beyond {} m", MAX_REACH / 1e3);
            return self.refuse(node, &what, "check its size and the drawing's unit, or simplify it");
        }
        let loops = path.elements().iter().filter(|e| matches!(e, PathEl::MoveTo(_))).count();
        if loops > 1 {
            let what =
                format!("has {loops} outlines: holes, or several plates; a plate is one closed outline without holes");
            let help = "remove the holes, or break the path apart into plates (Inkscape: Path, Break Apart)";
            return self.refuse(node, &what, help);
        }
        let mut points: Vec<DVec2> = Vec::new();
        let mut closed = false;
        kurbo::flatten(&path, FLATNESS, |element| match element {
            PathEl::MoveTo(p) | PathEl::LineTo(p) => points.push(DVec2::new(p.x, p.y)),
            PathEl::ClosePath => closed = true,
            PathEl::QuadTo(..) | PathEl::CurveTo(..) => {}
        });
        if points.iter().any(|p| !p.is_finite()) {
            return self.refuse(node, "has coordinates that are not numbers", "draw it again");
        }
        let near = |a: DVec2, b: DVec2| a.distance(b) < FLATNESS;
        let meets = points.len() > 2 && near(points[0], points[points.len() - 1]);
        if !closed && !meets {
            return self.refuse(node, "is an open line", "close it: a plate needs a closed outline");
        }
        points.dedup_by(|b, a| near(*a, *b));
        while points.len() > 1 && near(points[0], points[points.len() - 1]) {
            points.pop();
        }
        if points.len() > MAX_CORNERS {
            let what = format!("has {} corners; the limit is {MAX_CORNERS}", points.len());
            return self.refuse(node, &what, "simplify the path (Inkscape: Path, Simplify)");
        }
        if let Some([a, b]) = crossing(&points) {
            let what = format!("crosses itself near ({:.1}, {:.1}) mm", 0.5 * (a.x + b.x), -0.5 * (a.y + b.y));
            return self.refuse(node, &what, "remove the loop, or draw two plates");
        }
        let area = if points.len() < 3 { 0.0 } else { area_and_centroid(&points).0 };
        if area.abs() < 1.0 {
            return self.refuse(node, "has no area", "draw a plate of at least 15 × 15 mm");
        }
        if area < 0.0 {
            points.reverse();
        }
        self.plates.push(Outline { name: element_name(node), polygon: points });
    }
}

/// Name of an element in messages: `<path id="fin">`.
fn element_name(node: Node) -> String {
    let name = node.tag_name().name();
    node.attribute("id").map_or_else(|| format!("<{name}>"), |id| format!("<{name} id=\"{id}\">"))
}

/// The points of a part of a path, with those that bend it.
fn points_of(part: &PathEl) -> impl Iterator<Item = kurbo::Point> + use<> {
    let points = match *part {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => [Some(p), None, None],
        PathEl::QuadTo(a, p) => [Some(a), Some(p), None],
        PathEl::CurveTo(a, b, p) => [Some(a), Some(b), Some(p)],
        PathEl::ClosePath => [None; 3],
    };
    points.into_iter().flatten()
}

/// Are all numbers of a path's data within the limit? `None` where it cannot be read.
fn moderate(data: &str) -> Option<bool> {
    use svgtypes::PathSegment as Segment;
    let numbers = |segment: Segment| match segment {
        Segment::MoveTo { x, y, .. } | Segment::LineTo { x, y, .. } | Segment::SmoothQuadratic { x, y, .. } => {
            [x, y, 0.0, 0.0, 0.0, 0.0]
        }
        Segment::HorizontalLineTo { x, .. } => [x, 0.0, 0.0, 0.0, 0.0, 0.0],
        Segment::VerticalLineTo { y, .. } => [y, 0.0, 0.0, 0.0, 0.0, 0.0],
        Segment::CurveTo { x1, y1, x2, y2, x, y, .. } => [x1, y1, x2, y2, x, y],
        Segment::SmoothCurveTo { x2, y2, x, y, .. } => [x2, y2, x, y, 0.0, 0.0],
        Segment::Quadratic { x1, y1, x, y, .. } => [x1, y1, x, y, 0.0, 0.0],
        Segment::EllipticalArc { rx, ry, x_axis_rotation, x, y, .. } => [rx, ry, x_axis_rotation, x, y, 0.0],
        Segment::ClosePath { .. } => [0.0; 6],
    };
    let mut all = true;
    for segment in svgtypes::PathParser::from(data) {
        all &= numbers(segment.ok()?).iter().all(|number| number.abs() <= MAX_NUMBER);
    }
    Some(all)
}

/// Length of a unit, mm; `None` for relative units.
fn millimetres(unit: LengthUnit) -> Option<f64> {
    Some(match unit {
        LengthUnit::Mm => 1.0,
        LengthUnit::Cm => 10.0,
        LengthUnit::In => INCH,
        LengthUnit::Pt => INCH / 72.0,
        LengthUnit::Pc => INCH / 6.0,
        LengthUnit::None | LengthUnit::Px => PIXEL,
        LengthUnit::Percent | LengthUnit::Em | LengthUnit::Ex => return None,
    })
}

/// The outline of an element in its own units; else why it has none, and what to do.
fn shape(node: Node) -> Result<BezPath, (String, &'static str)> {
    let number = |key: &str| -> Result<f64, (String, &'static str)> {
        let Some(text) = node.attribute(key) else { return Ok(0.0) };
        let length = text.parse::<Length>().ok();
        let value = length.and_then(|l| match l.unit {
            LengthUnit::None => Some(l.number),
            // Absolute units are multiples of pixels inside a drawing.
            unit => millimetres(unit).map(|mm| l.number * mm / PIXEL),
        });
        match value {
            Some(value) if value.abs() <= MAX_NUMBER => Ok(value),
            Some(_) => Err((format!("has {key} = \"{text}\"; numbers go to {MAX_NUMBER:e}"), "draw it smaller")),
            None => Err((format!("has {key} = \"{text}\", which is not a length"), "save it as plain SVG")),
        }
    };
    const TOLERANCE: f64 = 0.01;
    match node.tag_name().name() {
        "path" => {
            let data = node.attribute("d").unwrap_or_default();
            if moderate(data) == Some(false) {
                return Err((format!("has numbers beyond {MAX_NUMBER:e}"), "draw it smaller"));
            }
            if moderate(data).is_none() && !data.trim().is_empty() {
                return Err(("has a path that cannot be read".into(), "save it again as plain SVG"));
            }
            BezPath::from_svg(data)
                .map_err(|error| (format!("has a path that cannot be read: {error}"), "save it again as plain SVG"))
        }
        "rect" => {
            let (x, y, w, h) = (number("x")?, number("y")?, number("width")?, number("height")?);
            let (rx, ry) = (number("rx")?, number("ry")?);
            let radius = if rx > 0.0 { rx } else { ry };
            Ok(kurbo::RoundedRect::new(x, y, x + w, y + h, radius.min(0.5 * w).min(0.5 * h)).to_path(TOLERANCE))
        }
        "circle" => Ok(kurbo::Circle::new((number("cx")?, number("cy")?), number("r")?).to_path(TOLERANCE)),
        "ellipse" => {
            let center = (number("cx")?, number("cy")?);
            Ok(kurbo::Ellipse::new(center, (number("rx")?, number("ry")?), 0.0).to_path(TOLERANCE))
        }
        name @ ("polygon" | "polyline") => {
            let mut path = BezPath::new();
            for (i, (x, y)) in PointsParser::from(node.attribute("points").unwrap_or_default()).enumerate() {
                if x.abs().max(y.abs()) > MAX_NUMBER {
                    return Err((format!("has numbers beyond {MAX_NUMBER:e}"), "draw it smaller"));
                }
                if i == 0 { path.move_to((x, y)) } else { path.line_to((x, y)) }
            }
            if name == "polygon" && !path.elements().is_empty() {
                path.close_path();
            }
            Ok(path)
        }
        "line" => Err(("is a line, not a plate".into(), "draw a closed outline")),
        "text" => Err(("is text".into(), "make it a path (Inkscape: Path, Object to Path), or remove it")),
        "image" => Err(("is a picture".into(), "trace it (Inkscape: Path, Trace Bitmap), or remove it")),
        "use" => {
            Err(("is a copy of another element".into(), "unlink it (Inkscape: Edit, Clone, Unlink), or remove it"))
        }
        _ => Err(("is not an outline".into(), "draw plates as paths, rectangles, circles, ellipses or polygons")),
    }
}

/// Two sides of a polygon that cross: the start of each.
fn crossing(points: &[DVec2]) -> Option<[DVec2; 2]> {
    let n = points.len();
    let side = |i: usize| (points[i], points[(i + 1) % n]);
    let turn = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
    for i in 0..n {
        let (a, b) = side(i);
        // The next side shares a corner with this one, and so does the last with the first.
        for k in i + 2..if i == 0 { n - 1 } else { n } {
            let (c, d) = side(k);
            if turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0 {
                return Some([a, c]);
            }
        }
    }
    None
}
