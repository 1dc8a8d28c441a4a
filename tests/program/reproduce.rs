//! The report, reproduced: the folder, its commands, and its verification.

use crate::support::ground::{GYROLAB, Ground, names, stdout};
use std::fs;
use std::os::unix::fs::symlink;

/// The commands in the code blocks of the page.
fn commands(page: &str) -> Vec<&str> {
    page.lines()
        .filter(|line| line.starts_with("gyrolab ") && line.contains(" -o "))
        .filter(|line| !line.contains("FOLDER"))
        .collect()
}

#[test]
#[ignore = "computes the report's runs three times: minutes"]
fn the_reproduced_report_is_verified_and_its_commands_write_its_files() {
    let ground = Ground::new();
    ground.stderr("reproduce -o report");
    let page = ground.read("report/README.md");
    assert!(!page.contains("n/a") && !page.contains("NaN"), "{page}");
    ground.stdout("verify report");

    let bin = ground.file("bin");
    fs::create_dir_all(&bin).unwrap();
    symlink(GYROLAB, bin.join("gyrolab")).unwrap();
    let commands = commands(&page);
    let script = format!(
        "set -e\nPATH={}:$PATH\nmkdir -p again/data again/figures\ncd again\n{}\n",
        bin.display(),
        commands.join("\n")
    );
    let output = ground.shell(&script);
    assert!(output.status.success(), "{output:?}");
    let mut count = 0;
    for folder in ["data", "figures"] {
        for name in names(&ground.file("again").join(folder)) {
            let [here, again] = ["report", "again"]
                .map(|place| fs::read(ground.file(place).join(folder).join(&name)).unwrap());
            assert!(here == again, "{folder}/{name}");
            count += 1;
        }
    }
    assert_eq!(count, commands.len());

    ground.write("report/README.md", &page.replacen("MATLAB", "Matlab", 1));
    let differs = ground.run("verify report");
    assert_eq!(differs.status.code(), Some(1));
    let said = stdout(&differs);
    assert!(said.contains("README.md: differs: line 5"), "{said}");
    assert_eq!(said.matches("differs").count(), 1, "{said}");
}

#[test]
fn a_folder_with_files_is_left_alone_without_force() {
    let ground = Ground::new();
    fs::create_dir(ground.file("mine")).unwrap();
    ground.write("mine/notes.txt", "mine");
    ground.refused("reproduce -o mine", 1, &["mine holds files", "--force"]);
    assert_eq!(names(&ground.file("mine")), ["notes.txt"]);
}
