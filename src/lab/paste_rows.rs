//! Saves rows of the user's own program that were pasted as measured data in a new file.

use super::answer::Refusal;
use super::command::Command;
use super::comparison::Comparison;
use super::files::Files;
use super::player::Player;
use crate::engine::scenario::Problems;
use crate::engine::text::printable::is_steering;
use toml::Table;

/// Maximum number of bytes that can be pasted.
pub const MOST_PASTED: usize = 1_000_000;

/// Saves the rows `text` in a new file. Returns a message, and the command that shows the rows with the run.
///
/// # Errors
/// Returns an error if the rows are not valid or the file cannot be written.
pub(super) fn keep(
    text: &str,
    files: &Files,
    comparison: &Comparison,
    player: &Player,
) -> Result<(String, Command), Refusal> {
    let reason = |problems: Problems| {
        let problems = problems.in_file("pasted data").to_string();
        problems.lines().next().unwrap_or_default().to_owned()
    };
    if text.len() > MOST_PASTED {
        let rule = "the pasted text is longer than 1 MB: print fewer rows, columns or digits";
        return Err(rule.into());
    }
    // Terminals paste the end of a line as the key Enter.
    let text = text.trim_start_matches('\u{feff}').replace("\r\n", "\n");
    let text = text.replace('\r', "\n");
    if text.contains(|c| is_steering(c) && !"\n\t".contains(c)) {
        return Err("the pasted text contains control characters: copy only the rows".into());
    }
    let name = files.free_name("pasted", "", "csv");
    let checked = comparison.check(&name, &text, player);
    let unjudged = checked.map_err(reason)?.map(reason);
    let path = files.path_of(&name);
    files.save("the pasted text", &text, &path, false)?;
    let is_confined = files.confined().is_some();
    let whole = std::path::absolute(&path).ok().filter(|_| !is_confined);
    let kept = whole
        .and_then(|whole| whole.to_str().map(str::to_owned))
        .unwrap_or_else(|| name.clone());
    let key = Table::from_iter([("view.measured".to_owned(), kept.into())]);
    let mut words = format!("the pasted rows are saved in {name}; u removes them");
    if let Some(why) = unjudged {
        words += &format!("; no verdict: {why}");
    }
    Ok((words, Command::Set(key)))
}
