//! The works in groups, as they stand on the page: a heading over the rows of each group, in the language shown.
//!
//! The site's configuration says which work belongs where; a curator regroups them in a text editor. A group in which no
//! work stands has no heading, and without groups the works stand in their order. A heading is never the last row of a
//! leaf.

use soffio_config::{Group, OTHERS};

/// A row of the page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Row {
    /// Heading of the group at this index.
    Heading(usize),
    /// Works by their index among those offered, as many as there are columns, or fewer.
    Exhibits(Vec<usize>),
}

/// All rows, for works with these ids in their order.
pub fn rows(ids: &[&str], groups: &[Group], columns: usize) -> Vec<Row> {
    let place = |id: &str| {
        let of = |name: &str| groups.iter().position(|group| group.works.iter().any(|work| work == name));
        of(id).or_else(|| of(OTHERS))
    };
    let mut rows = Vec::new();
    // Works in no group come last.
    for group in (0..groups.len()).map(Some).chain([None]) {
        let members: Vec<usize> = (0..ids.len()).filter(|&i| place(ids[i]) == group).collect();
        if members.is_empty() {
            continue;
        }
        rows.extend(group.map(Row::Heading));
        rows.extend(members.chunks(columns.max(1)).map(|works| Row::Exhibits(works.to_vec())));
    }
    rows
}

/// Rows by leaves of this height, given the heights of a heading and of a row of works.
pub fn paginate(rows: Vec<Row>, room: f32, heading: f32, works: f32) -> Vec<Vec<Row>> {
    let (mut leaves, mut left) = (vec![Vec::new()], room);
    for row in rows {
        // With a heading goes the first row under it.
        let (height, needed) = match row {
            Row::Heading(_) => (heading, heading + works),
            Row::Exhibits(_) => (works, works),
        };
        if needed > left && leaves.last().is_some_and(|leaf| !leaf.is_empty()) {
            // The row after a heading was thought of with it.
            if !matches!(leaves.last().and_then(|leaf| leaf.last()), Some(Row::Heading(_))) {
                leaves.push(Vec::new());
                left = room;
            }
        }
        left -= height;
        if let Some(leaf) = leaves.last_mut() {
            leaf.push(row);
        }
    }
    leaves
}

/// A group's heading in a language, or else in English, or whatever there is.
pub fn heading<'a>(group: &'a Group, language: &str) -> &'a str {
    let base = language.split(['-', '_']).next().unwrap_or(language);
    let find = |code: &str| group.heading.get(code);
    let found = find(language).or_else(|| find(base)).or_else(|| find("en")).or_else(|| group.heading.values().next());
    found.map_or("", String::as_str)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(name: &str, works: &[&str]) -> Group {
        let heading = [("en".to_owned(), name.to_owned()), ("it".to_owned(), format!("{name}, in italiano"))];
        Group { heading: heading.into(), works: works.iter().map(|id| (*id).to_owned()).collect() }
    }

    #[test]
    fn works_stand_under_their_groups_heading_in_their_own_order() {
        let ids = ["fish", "chimes", "moons", "clock", "bell"];
        let groups = [group("mobiles", &["moons", "fish"]), group("empty", &["nothing"]), group("clocks", &["clock"])];
        let all = rows(&ids, &groups, 2);
        let expected = [
            Row::Heading(0),
            Row::Exhibits(vec![0, 2]),
            Row::Heading(2),
            Row::Exhibits(vec![3]),
            // In no group.
            Row::Exhibits(vec![1, 4]),
        ];
        assert_eq!(all, expected);
        let rest = [group("mobiles", &["moons"]), group("rest", &["*"])];
        assert_eq!(rows(&ids, &rest, 4)[2..], [Row::Heading(1), Row::Exhibits(vec![0, 1, 3, 4])]);
        assert_eq!(rows(&ids, &[], 3), [Row::Exhibits(vec![0, 1, 2]), Row::Exhibits(vec![3, 4])]);
        assert_eq!((heading(&groups[0], "it-CH"), heading(&groups[0], "ko")), ("mobiles, in italiano", "mobiles"));
    }

    #[test]
    fn every_row_is_on_a_leaf_and_no_heading_ends_one() {
        let ids: Vec<String> = (0..40).map(|i| format!("work-{i}")).collect();
        let ids: Vec<&str> = ids.iter().map(String::as_str).collect();
        let groups: Vec<Group> = ids.chunks(3).map(|works| group("some", works)).collect();
        for room in [5.0, 20.0, 25.0, 31.0, 47.0, 1000.0] {
            let all = rows(&ids, &groups, 2);
            let split = paginate(all.clone(), room, 4.0, 10.0);
            assert_eq!(split.concat(), all, "{room}");
            for leaf in &split {
                assert!(matches!(leaf.last(), Some(Row::Exhibits(_))), "{room}: {leaf:?}");
                let height: f32 = leaf.iter().map(|row| if let Row::Heading(_) = row { 4.0 } else { 10.0 }).sum();
                // What does not fit at all stands there all the same: one row, and its heading.
                assert!(height <= room.max(14.0), "{room}: {leaf:?}");
            }
        }
    }
}
