//! Layout of the exhibits in groups: a heading over the rows of each group, divided into pages.
//!
//! `exhibits.groups` of the configuration assigns the exhibits. A group without exhibits has no heading. A heading is never
//! the last row of a page.

use soffio_config::{ExhibitGroup, OTHERS};

/// A row of a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Row {
    /// Heading of the group at this index.
    Heading(usize),
    /// Indices of the exhibits among those offered, at most one for each column.
    Exhibits(Vec<usize>),
}

/// All rows for the exhibits with these ids.
pub fn rows(ids: &[&str], groups: &[ExhibitGroup], columns: usize) -> Vec<Row> {
    let place = |id: &str| {
        let of = |name: &str| groups.iter().position(|group| group.exhibits.iter().any(|id| id == name));
        of(id).or_else(|| of(OTHERS))
    };
    let mut rows = Vec::new();
    // Exhibits in no group come last.
    for group in (0..groups.len()).map(Some).chain([None]) {
        let members: Vec<usize> = (0..ids.len()).filter(|&i| place(ids[i]) == group).collect();
        if members.is_empty() {
            continue;
        }
        rows.extend(group.map(Row::Heading));
        rows.extend(members.chunks(columns.max(1)).map(|exhibits| Row::Exhibits(exhibits.to_vec())));
    }
    rows
}

/// Divides rows into pages of the height `page`, given the heights of a heading and of a row of exhibits.
pub fn paginate(rows: Vec<Row>, page: f32, heading: f32, exhibits: f32) -> Vec<Vec<Row>> {
    let (mut pages, mut left) = (vec![Vec::new()], page);
    for row in rows {
        // A heading stays with the first row under it.
        let (height, needed) = match row {
            Row::Heading(_) => (heading, heading + exhibits),
            Row::Exhibits(_) => (exhibits, exhibits),
        };
        if needed > left && pages.last().is_some_and(|rows| !rows.is_empty()) {
            // The heading reserved the space of the row after it.
            if !matches!(pages.last().and_then(|rows| rows.last()), Some(Row::Heading(_))) {
                pages.push(Vec::new());
                left = page;
            }
        }
        left -= height;
        if let Some(rows) = pages.last_mut() {
            rows.push(row);
        }
    }
    pages
}

/// A group's heading in a language, else in English, else in any language.
pub fn heading<'a>(group: &'a ExhibitGroup, language: &str) -> &'a str {
    let base = language.split(['-', '_']).next().unwrap_or(language);
    let find = |code: &str| group.heading.get(code);
    let found = find(language).or_else(|| find(base)).or_else(|| find("en")).or_else(|| group.heading.values().next());
    found.map_or("", String::as_str)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(name: &str, ids: &[&str]) -> ExhibitGroup {
        let heading = [("en".to_owned(), name.to_owned()), ("it".to_owned(), format!("{name}, in italiano"))];
        ExhibitGroup { heading: heading.into(), exhibits: ids.iter().map(|id| (*id).to_owned()).collect() }
    }

    #[test]
    fn exhibits_are_listed_under_their_groups_heading() {
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
    fn every_row_is_on_a_page_and_no_heading_ends_one() {
        let ids: Vec<String> = (0..40).map(|i| format!("work-{i}")).collect();
        let ids: Vec<&str> = ids.iter().map(String::as_str).collect();
        let groups: Vec<ExhibitGroup> = ids.chunks(3).map(|ids| group("some", ids)).collect();
        for height in [5.0, 20.0, 25.0, 31.0, 47.0, 1000.0] {
            let all = rows(&ids, &groups, 2);
            let split = paginate(all.clone(), height, 4.0, 10.0);
            assert_eq!(split.concat(), all, "{height}");
            for page in &split {
                assert!(matches!(page.last(), Some(Row::Exhibits(_))), "{height}: {page:?}");
                let used: f32 = page.iter().map(|row| if let Row::Heading(_) = row { 4.0 } else { 10.0 }).sum();
                // A page that is too low still holds one row and its heading.
                assert!(used <= height.max(14.0), "{height}: {page:?}");
            }
        }
    }
}
