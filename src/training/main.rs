//! `soffio-training`: a developer's tool, apart from the program.

fn main() -> std::process::ExitCode {
    soffio_training::commands::run()
}
