//! The lines of the parameters pane while it has the focus, and the selected one.

/// One value as the pane shows it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Line {
    /// Dotted key, as `--set` takes it; empty for the push to come.
    pub key: String,
    /// The heading under which it stands.
    pub group: String,
    /// Short name.
    pub label: String,
    /// The value with all its digits.
    pub value: String,
    /// Its unit, or nothing.
    pub unit: String,
    /// Whether the scenario does not contain it: the value is the default.
    pub is_default: bool,
}

/// The lines and the selected one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Editor {
    lines: Vec<Line>,
    selected: usize,
}

impl Editor {
    /// Replaces the lines. The selection stays on the line of the same group and label, or else at the same number.
    pub fn set_lines(&mut self, lines: Vec<Line>) {
        let was = self
            .selected()
            .map(|line| (line.group.clone(), line.label.clone()));
        self.lines = lines;
        let stays = was.is_some_and(|(group, label)| self.select(&group, &label));
        if !stays {
            self.selected = self.selected.min(self.last());
        }
    }

    /// Moves the selection by `rows` lines; it stops at both ends.
    pub fn shift(&mut self, rows: isize) {
        self.selected = self.selected.saturating_add_signed(rows).min(self.last());
    }

    /// Selects the line `label` of `group`; returns whether there is one.
    pub fn select(&mut self, group: &str, label: &str) -> bool {
        let is_it = |line: &Line| line.group == group && line.label == label;
        let found = self.lines.iter().position(is_it);
        self.selected = found.unwrap_or(self.selected);
        found.is_some()
    }

    /// The selected line; `None` where there are no lines.
    pub fn selected(&self) -> Option<&Line> {
        self.lines.get(self.selected)
    }

    /// The number of the selected line, from 0.
    pub fn selected_index(&self) -> usize {
        self.selected
    }

    /// All lines, in order.
    pub fn lines(&self) -> &[Line] {
        &self.lines
    }

    fn last(&self) -> usize {
        self.lines.len().saturating_sub(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(group: &str, label: &str) -> Line {
        Line {
            group: group.to_owned(),
            label: label.to_owned(),
            ..Line::default()
        }
    }

    fn editor(lines: &[(&str, &str)]) -> Editor {
        let mut editor = Editor::default();
        editor.set_lines(lines.iter().map(|(g, l)| line(g, l)).collect());
        editor
    }

    fn selected(editor: &Editor) -> (&str, &str) {
        let line = editor.selected().unwrap();
        (&line.group, &line.label)
    }

    #[test]
    fn the_selection_stays_on_its_line() {
        let mut editor = editor(&[("start", "tilt"), ("motion", "dt"), ("push 0", "steps")]);
        assert!(editor.select("motion", "dt"));
        editor.set_lines(vec![
            line("body", "dt"),
            line("start", "tilt"),
            line("motion", "dt"),
        ]);
        assert_eq!(selected(&editor), ("motion", "dt"));
        // Gone: the line that stands there now, or the last.
        editor.set_lines(vec![line("start", "tilt"), line("start", "Lx")]);
        assert_eq!(selected(&editor), ("start", "Lx"));
        editor.set_lines(Vec::new());
        assert_eq!(editor.selected(), None);
    }

    #[test]
    fn the_selection_stops_at_both_ends() {
        let mut editor = editor(&[("a", "1"), ("a", "2"), ("b", "1")]);
        editor.shift(1);
        assert_eq!(selected(&editor), ("a", "2"));
        editor.shift(1000);
        assert_eq!(selected(&editor), ("b", "1"));
        editor.shift(isize::MIN);
        assert_eq!(selected(&editor), ("a", "1"));
        assert!(!editor.select("c", "1"));
        assert_eq!(selected(&editor), ("a", "1"));
        Editor::default().shift(3);
    }
}
