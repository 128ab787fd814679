//! Every shader is valid before any driver sees it.

use soffio::render::SHADERS;
use wgpu::naga;

#[test]
fn every_shader_parses_and_validates() {
    for (name, source) in SHADERS {
        let module = naga::front::wgsl::parse_str(source)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)));
        // No capability beyond core WebGPU: every adapter takes them.
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)));
        assert!(module.entry_points.len() >= 2 || name == "shadows", "{name} has a vertex and a fragment stage");
    }
}

#[test]
fn every_shader_file_is_part_of_a_shader() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    for entry in std::fs::read_dir(folder).expect("the shaders' folder") {
        let path = entry.expect("an entry").path();
        let text = std::fs::read_to_string(&path).expect("text");
        assert!(SHADERS.iter().any(|(_, source)| source.contains(&text)), "{} is not used", path.display());
    }
}
