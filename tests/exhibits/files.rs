//! The files of an exhibit: they load without a warning, and what is written from them reads back.

use std::path::Path;

use soffio_exhibit as exhibit;
use soffio_exhibit::labels::{from_csv, to_csv};
use soffio_exhibit::model::{self, Model};
use soffio_math::DVec3;
use soffio_offline::export::mjcf;

use crate::load;

/// Single precision of numbers near 1.
const SINGLE: f64 = 1e-6;

pub fn loads_without_a_warning(id: &str) {
    let folder = exhibit::resolve(id).expect("an id that was listed");
    let loaded = exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}:\n{}", report.to_text()));
    assert!(loaded.warnings.is_empty(), "{id}: {:#?}", loaded.warnings);
    assert_eq!(loaded.id, id);
}

pub fn has_its_picture_in_the_readme(id: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = std::fs::read_to_string(root.join("README.md")).expect("a README");
    let picture = format!("exhibits/{id}/thumbnail.png");
    assert!(readme.contains(&picture), "{id} has no picture in the README");
    assert!(root.join(&picture).is_file(), "{picture} is missing");
}

/// Writes bytes as a `.glb` and reads them with the loader of all models.
fn read(bytes: &[u8]) -> Model {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("model.glb");
    std::fs::write(&path, bytes).expect("writable");
    model::load(&path).unwrap_or_else(|report| panic!("{report}"))
}

pub fn its_model_reads_back_as_it_was_written(id: &str) {
    let before = &load(id).model;
    let after = read(&soffio_authoring::model_writer::write(before, "nobody"));
    assert_eq!(format!("{:?}", before.materials), format!("{:?}", after.materials), "{id}");
    assert_eq!(before.cameras.len(), after.cameras.len(), "{id}");
    let drawn = |model: &Model| -> Vec<(DVec3, Vec<u32>)> {
        let meshes = model.nodes.iter().filter_map(|node| Some((node.world, model.meshes.get(node.mesh?)?)));
        let parts = meshes.flat_map(|(world, mesh)| mesh.primitives.iter().map(move |part| (world, part)));
        parts
            .map(|(world, part)| {
                let corners = part.positions.iter().map(|p| DVec3::from(p.map(f64::from)));
                (corners.map(|p| world.transform_point3(p)).sum(), part.indices.clone())
            })
            .collect()
    };
    for ((one, corners), (other, again)) in drawn(before).into_iter().zip(drawn(&after)) {
        assert_eq!(corners, again, "{id}");
        let size = SINGLE * corners.len() as f64;
        assert!(one.distance(other) < size, "{id}: {one} {other}");
    }
    assert_eq!(drawn(before).len(), drawn(&after).len(), "{id}");
}

pub fn its_constraints_are_in_its_mujoco_model_or_named_as_omitted(id: &str) {
    let exhibit = load(id);
    let mjcf::Exported { text, omitted } = mjcf::export(&exhibit);
    let output = |name: &str| {
        let escaped = name.replace('&', "&amp;");
        text.contains(&escaped) || omitted.iter().any(|line| line.starts_with(&format!("{name}:")))
    };
    for constraint in &exhibit.constraints {
        assert!(output(&constraint.name) || output(constraint.group()), "{id}: {}", constraint.name);
    }
    for name in exhibit.springs.iter().map(|s| &s.name).chain(exhibit.bodies.iter().map(|b| &b.name)) {
        assert!(output(name), "{id}: {name}");
    }
    assert_eq!(text.matches("<body ").count(), exhibit.bodies.len(), "{id}");
    assert_eq!(text.matches("<pair ").count(), exhibit.collider_pairs().meet.len(), "{id}");
    assert_eq!(text.matches("<body ").count(), text.matches("</body>").count(), "{id}");
}

/// As it is, and as spreadsheets write it: other separators and ends of lines, no mark.
pub fn its_table_of_labels_reads_back(id: &str) {
    let path = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}")).join(exhibit::SIDECAR);
    let sidecar = std::fs::read_to_string(path).expect("a sidecar");
    let table = to_csv(id, &sidecar).unwrap_or_else(|report| panic!("{id}: {report}"));
    let back = from_csv(id, &sidecar, "t", &table).unwrap_or_else(|report| panic!("{id}: {report}"));
    assert!(back.sidecar == sidecar && back.changed == 0, "{id}");
    let mut reader =
        csv::ReaderBuilder::new().has_headers(false).from_reader(table.trim_start_matches('\u{feff}').as_bytes());
    let mut writer = csv::WriterBuilder::new()
        .delimiter(b';')
        .terminator(csv::Terminator::CRLF)
        .quote_style(csv::QuoteStyle::Always)
        .from_writer(Vec::new());
    for row in reader.records() {
        writer.write_record(row.expect("a row").iter().map(|cell| cell.replace('\n', "\r\n"))).expect("memory");
    }
    let text = String::from_utf8(writer.into_inner().expect("memory")).expect("UTF-8");
    // A head in quotes begins with one: spreadsheets write words without.
    let text = text.replacen("\"key\";", "key;", 1);
    let back = from_csv(id, &sidecar, "t", &text).unwrap_or_else(|report| panic!("{id}: {report}"));
    assert!(back.sidecar == sidecar && back.changed == 0, "{id}: as a spreadsheet writes it");
}
