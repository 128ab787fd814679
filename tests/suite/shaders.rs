//! Every shader is valid before any driver sees it.

use soffio::render::Shaders;
use soffio::render::shaders::{ShaderError, validate};

#[test]
fn every_shader_parses_and_validates() {
    for (name, source) in Shaders::default().iter() {
        let module = validate(source).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(module.entry_points.len() >= 2, "{name} has a vertex and a fragment stage");
    }
}

#[test]
fn a_folder_of_shaders_is_taken_whole_or_not_at_all() {
    let shipped = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    assert!(Shaders::load(&shipped).expect("the shipped ones are valid") == Shaders::default());
    let folder = tempfile::tempdir().expect("a folder");
    for entry in std::fs::read_dir(&shipped).expect("the shaders' folder") {
        let path = entry.expect("an entry").path();
        std::fs::copy(&path, folder.path().join(path.file_name().expect("a name"))).expect("a copy");
    }
    std::fs::write(folder.path().join("room.wgsl"), "fn fragment( {").expect("written");
    let error = Shaders::load(folder.path()).expect_err("room.wgsl is broken");
    assert!(matches!(error, ShaderError::Invalid("room", _)), "{error}");
}

#[test]
fn every_shader_file_is_part_of_a_shader() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    for entry in std::fs::read_dir(folder).expect("the shaders' folder") {
        let path = entry.expect("an entry").path();
        let text = std::fs::read_to_string(&path).expect("text");
        assert!(Shaders::default().iter().any(|(_, source)| source.contains(&text)), "{} is not used", path.display());
    }
}
