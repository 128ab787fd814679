//! Development probe: prints one JSON array of problems a file, like soffio check --json.
fn main() {
    for path in std::env::args().skip(1) {
        let start = std::time::Instant::now();
        let report = match soffio_exhibit::load_model(std::path::Path::new(&path)) {
            Ok(exhibit) => soffio_exhibit::Report::from(exhibit.warnings),
            Err(report) => report,
        };
        println!("{}\t{:.3}\t{}", path, start.elapsed().as_secs_f64(), report.to_json());
    }
}
