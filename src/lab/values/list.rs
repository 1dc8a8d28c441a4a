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

/// The lines, the selected one, and a part of a name: while there is one, only lines that have it are shown.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Editor {
    lines: Vec<Line>,
    /// The number of the selected line among all, from 0.
    selected: usize,
    name: String,
}

impl Line {
    /// Whether each word of `name` is a part of its group, label or key, in capitals or not.
    fn has(&self, name: &str) -> bool {
        let names = format!("{} {} {}", self.group, self.label, self.key).to_lowercase();
        let name = name.to_lowercase();
        name.split_whitespace().all(|word| names.contains(word))
    }
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
            self.selected = self.selected.min(self.lines.len().saturating_sub(1));
            self.keep_shown();
        }
    }

    /// Shows only the lines that have `name` in their names; all of them where it is empty. The selection stays on its
    /// line, or moves to the first that is shown.
    pub fn filter(&mut self, name: String) {
        self.name = name;
        self.keep_shown();
    }

    /// The part of a name that all lines shown have; empty where every line is shown.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Moves the selection by `rows` of the lines that are shown; it stops at both ends.
    pub fn shift(&mut self, rows: isize) {
        let shown = self.indices();
        let here = shown.iter().position(|&index| index == self.selected);
        let next = here.unwrap_or(0).saturating_add_signed(rows);
        let next = shown.get(next).or(shown.last());
        self.selected = next.copied().unwrap_or(self.selected);
    }

    /// Selects the line `label` of `group`; returns whether there is one.
    pub fn select(&mut self, group: &str, label: &str) -> bool {
        let is_it = |line: &Line| line.group == group && line.label == label;
        let found = self.lines.iter().position(is_it);
        self.selected = found.unwrap_or(self.selected);
        found.is_some()
    }

    /// The selected line; `None` where no lines are shown.
    pub fn selected(&self) -> Option<&Line> {
        let line = self.lines.get(self.selected)?;
        line.has(&self.name).then_some(line)
    }

    /// The number of the selected line among all lines, from 0.
    pub fn selected_index(&self) -> usize {
        self.selected
    }

    /// All lines, in order.
    pub fn lines(&self) -> &[Line] {
        &self.lines
    }

    /// The lines that are shown, in order, each with its number among all.
    pub fn shown(&self) -> Vec<(usize, &Line)> {
        let lines = self.lines.iter().enumerate();
        lines.filter(|(_, line)| line.has(&self.name)).collect()
    }

    fn indices(&self) -> Vec<usize> {
        self.shown().into_iter().map(|(index, _)| index).collect()
    }

    fn keep_shown(&mut self) {
        if self.selected().is_none() {
            let first = self.indices().first().copied();
            self.selected = first.unwrap_or(self.selected);
        }
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

    #[test]
    fn only_lines_with_the_name_are_shown_and_selected() {
        let mut editor = editor(&[("start", "tilt"), ("motion", "dt"), ("push 0", "steps")]);
        editor.lines[1].key = "motion.time_step_s".to_owned();
        for (name, shown) in [
            ("", 3),
            ("ti", 2),
            ("TIME step", 1),
            ("push st", 1),
            ("nothing", 0),
        ] {
            editor.filter(name.to_owned());
            assert_eq!(editor.shown().len(), shown, "{name}");
            assert_eq!(editor.selected().is_some(), shown > 0, "{name}");
            editor.shift(5);
            let last = editor.shown().last().map(|(index, _)| *index);
            assert_eq!(
                last.unwrap_or(editor.selected_index()),
                editor.selected_index()
            );
        }
        editor.filter("tilt".to_owned());
        assert_eq!(selected(&editor), ("start", "tilt"));
        // Found again among other lines.
        editor.set_lines(vec![line("a", "b"), line("start", "tilt")]);
        assert_eq!(selected(&editor), ("start", "tilt"));
    }
}
