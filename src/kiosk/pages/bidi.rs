//! Text that is read from the right, alone or among words from the left: Unicode's bidirectional algorithm (UAX 9), line by
//! line, for a panel library that sets everything from the left.
//!
//! The library shapes each piece of text in its own script's direction, so letters of Arabic join and marks of Hebrew stand
//! where they belong; but it sets pieces one after the other as they are given. So a line is given as its pieces in the
//! order in which they stand on the glass: a run from the left is one piece, a run from the right is its words in reverse,
//! with spaces, points and mirrored brackets between them. Lines are broken before that, in the order of reading.

use std::ops::Range;

use unicode_bidi::{BidiClass, BidiInfo, Level, ParagraphInfo, bidi_class};
use unicode_bidi_mirroring::get_mirrored;

/// A line's pieces from left to right.
pub type Line = Vec<String>;

/// Is there anything that is read from the right?
pub fn has_right_to_left(text: &str) -> bool {
    text.chars().any(is_right_to_left_char)
}

/// Is its first word, or are at least half of its words read from the right? A text's own direction: the first letter alone,
/// as UAX 9 takes it where nothing else is known, would turn a Hebrew sentence about that begins with a Latin name.
pub fn is_right_to_left(text: &str) -> bool {
    let way = |word: &str| {
        word.chars().map(bidi_class).find(|class| matches!(class, BidiClass::L | BidiClass::R | BidiClass::AL))
    };
    let ways: Vec<BidiClass> = text.split_whitespace().filter_map(way).collect();
    let left = ways.iter().filter(|class| **class == BidiClass::L).count();
    let first = ways.first().is_some_and(|class| *class != BidiClass::L);
    first || (left < ways.len() && 2 * left <= ways.len())
}

/// The lines of a text, none longer than `longest` where a space lies before that; `width` measures a piece.
pub fn lines(text: &str, longest: f32, mut width: impl FnMut(&str) -> f32) -> Vec<Line> {
    let base = if is_right_to_left(text) { Level::rtl() } else { Level::ltr() };
    let info = BidiInfo::new(text, Some(base));
    let mut all = Vec::new();
    for paragraph in &info.paragraphs {
        let mut line: Option<(Range<usize>, f32)> = None;
        for word in word_ranges(text, paragraph.range.clone()) {
            let length = |range: Range<usize>, width: &mut dyn FnMut(&str) -> f32| -> f32 {
                pieces(&info, paragraph, range).iter().map(|piece| width(piece)).sum()
            };
            let own = length(word.clone(), &mut width);
            line = Some(match line.take() {
                Some((so_far, long)) => {
                    let space = length(so_far.end..word.start, &mut width);
                    if long + space + own > longest {
                        all.push(pieces(&info, paragraph, so_far));
                        (word, own)
                    } else {
                        (so_far.start..word.end, long + space + own)
                    }
                }
                None => (word, own),
            });
        }
        all.push(line.map(|(range, _)| pieces(&info, paragraph, range)).unwrap_or_default());
    }
    all
}

/// Does it stand in a script that is read from the right?
fn is_right_to_left_char(c: char) -> bool {
    matches!(bidi_class(c), BidiClass::R | BidiClass::AL)
}

/// What lies between white space.
fn word_ranges(text: &str, paragraph: Range<usize>) -> Vec<Range<usize>> {
    let mut words = Vec::new();
    let mut begun = None;
    for (i, c) in text[paragraph.clone()].char_indices() {
        let at = paragraph.start + i;
        match (c.is_whitespace(), begun) {
            (false, None) => begun = Some(at),
            (true, Some(start)) => {
                words.push(start..at);
                begun = None;
            }
            _ => {}
        }
    }
    words.extend(begun.map(|start| start..paragraph.end));
    words
}

/// A line's pieces from left to right.
fn pieces(info: &BidiInfo, paragraph: &ParagraphInfo, line: Range<usize>) -> Line {
    let (levels, runs) = info.visual_runs(paragraph, line);
    let mut pieces = Vec::new();
    for run in runs {
        let text = &info.text[run.clone()];
        match levels[run.start].is_rtl() {
            true => pieces.extend(right_to_left_pieces(text)),
            false => pieces.extend(left_to_right_pieces(text)),
        }
    }
    pieces
}

/// A run from the left. The shaper turns the digits of Arabic about, of whose script they are: they are given it reversed.
fn left_to_right_pieces(run: &str) -> Vec<String> {
    let digit = |c: char| bidi_class(c) == BidiClass::AN;
    let mut pieces: Vec<(bool, String)> = Vec::new();
    for c in run.chars() {
        match pieces.last_mut().filter(|(of_digits, _)| *of_digits == digit(c)) {
            Some((true, piece)) => piece.insert(0, c),
            Some((false, piece)) => piece.push(c),
            None => pieces.push((digit(c), c.into())),
        }
    }
    pieces.into_iter().map(|(_, piece)| piece).collect()
}

/// A run from the right: words whole, as they are read (the shaper turns them), the rest sign by sign, mirrored.
fn right_to_left_pieces(run: &str) -> Vec<String> {
    let letter = |c: char| is_right_to_left_char(c) || matches!(bidi_class(c), BidiClass::NSM | BidiClass::BN);
    let mut pieces: Vec<(bool, String)> = Vec::new();
    for c in run.chars() {
        let is_letter = letter(c);
        match pieces.last_mut().filter(|(of_letters, _)| *of_letters == is_letter) {
            Some((_, piece)) => piece.push(c),
            None => pieces.push((is_letter, c.into())),
        }
    }
    let turn = |(of_letters, piece): (bool, String)| match of_letters {
        true => piece,
        false => piece.chars().rev().map(|c| get_mirrored(c).unwrap_or(c)).collect(),
    };
    pieces.into_iter().rev().map(turn).collect()
}
