//! Every shader is valid before any driver sees it.

use soffio_render::Shaders;
use soffio_render::shaders::{ShaderError, validate};

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
    std::fs::write(folder.path().join("gallery.wgsl"), "fn fragment( {").expect("written");
    let error = Shaders::load(folder.path()).expect_err("gallery.wgsl is broken");
    assert!(matches!(error, ShaderError::Invalid("gallery", _)), "{error}");
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

#[cfg(feature = "kiosk")]
#[test]
fn a_kiosk_reads_changed_shaders_and_says_what_is_wrong_with_them() {
    use soffio_kiosk::window::shader_watcher::ShaderWatcher;
    let folder = tempfile::tempdir().expect("a folder");
    for file in std::fs::read_dir("shaders").expect("the shaders").flatten() {
        std::fs::copy(file.path(), folder.path().join(file.file_name())).expect("copied");
    }
    let mut shaders = ShaderWatcher::new(folder.path().into());
    assert!(shaders.reload_if_changed(0.0).is_some_and(|read| read.is_ok()), "the first look reads them");
    assert!(shaders.reload_if_changed(1.0).is_none(), "nothing has changed");
    let path = folder.path().join("dust.wgsl");
    let good = std::fs::read_to_string(&path).expect("read");
    std::fs::write(&path, "fn vertex( {").expect("written");
    assert!(shaders.reload_if_changed(2.0).is_some_and(|read| read.is_err()), "a mistake is said");
    assert!(shaders.reload_if_changed(2.1).is_none(), "not at every picture");
    std::fs::write(&path, good + "// mended\n").expect("written");
    assert!(shaders.reload_if_changed(3.0).is_some_and(|read| read.is_ok()), "and what is mended is taken");
}
