//! A temporary working directory for the program, and its files.

use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::Arc;
use tempfile::TempDir;

pub const GYROLAB: &str = env!("CARGO_BIN_EXE_gyrolab");
pub(super) const VARIABLES: [(&str, &str); 2] = [("TERM", "xterm"), ("LANG", "C.UTF-8")];

/// Arguments of the program: a list, or a line in shell syntax.
pub trait Args {
    fn list(self) -> Vec<String>;
}

impl Args for &str {
    fn list(self) -> Vec<String> {
        shlex::split(self).unwrap()
    }
}

impl Args for &String {
    fn list(self) -> Vec<String> {
        self.as_str().list()
    }
}

impl Args for &[&str] {
    fn list(self) -> Vec<String> {
        self.iter().map(ToString::to_string).collect()
    }
}

impl<const N: usize> Args for &[&str; N] {
    fn list(self) -> Vec<String> {
        self[..].list()
    }
}

impl Args for &Vec<&str> {
    fn list(self) -> Vec<String> {
        self[..].list()
    }
}

/// A temporary working directory for the program, with a subfolder for its sessions. It is removed with its last clone.
#[derive(Clone)]
pub struct Ground(Arc<TempDir>);

impl Ground {
    pub fn new() -> Self {
        Self(Arc::new(tempfile::tempdir().unwrap()))
    }

    /// Creates a directory with a name that begins with `prefix`.
    pub fn named(prefix: &str) -> Self {
        Self(Arc::new(
            tempfile::Builder::new().prefix(prefix).tempdir().unwrap(),
        ))
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    pub fn file(&self, name: &str) -> PathBuf {
        self.path().join(name)
    }

    /// Returns the folder that contains the session folder.
    pub fn state(&self) -> PathBuf {
        self.file("state")
    }

    /// Returns the folder that contains the folder of the user's settings.
    pub fn config(&self) -> PathBuf {
        self.file("config")
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.file(name)).unwrap()
    }

    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.file(name), text).unwrap();
    }

    /// Returns the sorted names of all files and folders in the directory, including hidden ones.
    pub fn files(&self) -> Vec<String> {
        names(self.path())
    }

    /// Returns the names of files in the session folder that end with `end`.
    pub fn session_files(&self, end: &str) -> Vec<String> {
        let mut names = names(&self.state().join("gyrolab"));
        names.retain(|name| name.ends_with(end));
        names
    }

    /// Returns the permission bits of a file.
    pub fn mode(&self, name: &str) -> u32 {
        let there = std::fs::metadata(self.file(name)).unwrap();
        there.permissions().mode() & 0o7777
    }

    /// Returns a command that starts the program without a terminal.
    pub fn command(&self, args: impl Args) -> Command {
        let mut command = self.command_in_folder(GYROLAB);
        command.args(args.list());
        command
    }

    /// Runs the program without a terminal, and returns its output.
    pub fn run(&self, args: impl Args) -> Output {
        self.command(args).output().unwrap()
    }

    /// Runs the program, which must succeed, and returns its stdout.
    #[track_caller]
    pub fn stdout(&self, args: impl Args) -> String {
        stdout(&done(self.run(args))).to_owned()
    }

    /// Runs the program, which must succeed, and returns its stderr.
    #[track_caller]
    pub fn stderr(&self, args: impl Args) -> String {
        stderr(&done(self.run(args))).to_owned()
    }

    /// Runs the program, which must succeed, and reads its stdout as JSON.
    #[track_caller]
    pub fn json(&self, args: impl Args) -> serde_json::Value {
        serde_json::from_str(&self.stdout(args)).unwrap()
    }

    /// Returns the names of the subcommands in the help.
    pub fn subcommands(&self) -> Vec<String> {
        let help = self.stdout("--help");
        let (_, below) = help.split_once("Commands:\n").unwrap();
        let (list, _) = below.split_once("\n\n").unwrap();
        list.lines()
            .filter_map(|line| line.strip_prefix("  "))
            .filter(|line| !line.starts_with(' ') && !line.starts_with("help "))
            .filter_map(|line| line.split(' ').next().map(str::to_owned))
            .collect()
    }

    /// Asserts that the program ends with the exit code `with`, without a panic, and that its message contains all `words`.
    #[track_caller]
    pub fn refused(&self, args: &str, with: i32, words: &[&str]) {
        refused(args, &self.run(args), with, words);
    }

    /// Creates a named pipe.
    pub fn make_fifo(&self, name: &str) {
        let made = Command::new("mkfifo").arg(self.file(name)).status();
        assert!(made.unwrap().success());
    }

    /// Runs `script` in a shell in which `$G` is the program.
    pub fn shell(&self, script: &str) -> Output {
        let mut shell = self.command_in_folder("sh");
        shell.args(["-c", script]).env("G", GYROLAB);
        shell.output().unwrap()
    }

    fn command_in_folder(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command
            .envs(VARIABLES)
            .env_remove("LC_ALL")
            .env("XDG_STATE_HOME", self.state())
            .env("XDG_CONFIG_HOME", self.config())
            .current_dir(self.path())
            .stdin(Stdio::null());
        command
    }
}

/// Returns the sorted names of all files and folders in `folder`, or an empty list if it does not exist.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let mut names: Vec<_> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort_unstable();
    names
}

#[track_caller]
pub fn code(output: &Output) -> i32 {
    let code = output.status.code();
    code.unwrap_or_else(|| panic!("ended by a signal: {output:?}"))
}

pub fn stdout(output: &Output) -> &str {
    std::str::from_utf8(&output.stdout).unwrap()
}

pub fn stderr(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).unwrap()
}

#[track_caller]
pub fn done(output: Output) -> Output {
    assert_eq!(code(&output), 0, "{output:?}");
    output
}

/// Asserts that the program failed with exit code 1 and without a panic, and that its message contains all `words`.
#[track_caller]
pub fn failed(output: &Output, words: &[&str]) {
    refused("", output, 1, words);
}

/// Asserts like `failed`, but for the exit code `with`. `what` names the case.
#[track_caller]
pub fn refused(what: &str, output: &Output, with: i32, words: &[&str]) {
    assert_eq!(code(output), with, "{what}: {output:?}");
    let said = String::from_utf8_lossy(&output.stderr);
    for word in words {
        assert!(said.contains(word), "{what}: {word:?} is not in: {said}");
    }
    assert!(!said.contains("panicked"), "{what}: {said}");
}
