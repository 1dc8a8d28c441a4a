//! The program `gyrolab`; all of it is in the library.

#[cfg(unix)]
fn main() -> std::process::ExitCode {
    gyrolab::cli::main()
}

#[cfg(not(unix))]
fn main() {
    compile_error!(
        "on Windows gyrolab runs in WSL, or over SSH on another machine: build it there"
    );
}
