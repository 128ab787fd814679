//! Bidirectional text: the Unicode bidirectional algorithm (UAX 9), line by line.
//!
//! The panel library shapes each piece of text in the direction of its script, so Arabic letters join and Hebrew marks stand in
//! place. It sets the pieces from left to right in the order given. A line is therefore given as its pieces in visual order: a
//! left-to-right run is one piece; a right-to-left run is its words in reverse, with spaces, punctuation and mirrored brackets
//! between them. Lines are broken before that, in logical order.

use std::ops::Range;

use unicode_bidi::{BidiClass, BidiInfo, Level, ParagraphInfo, bidi_class};
use unicode_bidi_mirroring::get_mirrored;

/// The pieces of a line in visual order, from left to right.
pub type Line = Vec<String>;

/// Does the text contain right-to-left characters?
pub fn has_right_to_left(text: &str) -> bool {
    text.chars().any(is_right_to_left_char)
}

/// The text's base direction: is its first word right-to-left, or at least half of its words? UAX 9's default, the first
/// strong character, would reverse a Hebrew sentence that begins with a Latin name.
pub fn is_right_to_left(text: &str) -> bool {
    let direction = |word: &str| {
        word.chars().map(bidi_class).find(|class| matches!(class, BidiClass::L | BidiClass::R | BidiClass::AL))
    };
    let directions: Vec<BidiClass> = text.split_whitespace().filter_map(direction).collect();
    let left = directions.iter().filter(|class| **class == BidiClass::L).count();
    let first = directions.first().is_some_and(|class| *class != BidiClass::L);
    first || (left < directions.len() && 2 * left <= directions.len())
}

/// Breaks a text at spaces into lines of at most `longest`; `width` measures a piece.
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

/// Does the character belong to a right-to-left script?
fn is_right_to_left_char(c: char) -> bool {
    matches!(bidi_class(c), BidiClass::R | BidiClass::AL)
}

/// Byte ranges of the words of a paragraph: the text between white space.
fn word_ranges(text: &str, paragraph: Range<usize>) -> Vec<Range<usize>> {
    let mut ranges = Vec::new();
    let mut begun = None;
    for (i, c) in text[paragraph.clone()].char_indices() {
        let at = paragraph.start + i;
        match (c.is_whitespace(), begun) {
            (false, None) => begun = Some(at),
            (true, Some(start)) => {
                ranges.push(start..at);
                begun = None;
            }
            _ => {}
        }
    }
    ranges.extend(begun.map(|start| start..paragraph.end));
    ranges
}

/// The pieces of a line in visual order.
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

/// The pieces of a left-to-right run. The shaper reverses Arabic digits with their script, so they are passed reversed.
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

/// The pieces of a right-to-left run: words in logical order, which the shaper reverses, and all other characters one by one,
/// mirrored.
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
