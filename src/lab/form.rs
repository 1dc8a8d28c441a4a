//! A form: a few fields to type into.

use super::action::FieldEdit;
use crate::engine::text::printable::is_steering;
use tui_input::{Input, InputRequest};

/// Maximum number of characters in a field.
const MOST_TYPED: usize = 1000;

/// A line of text input. The cursor moves by visible characters, which may consist of several code points each.
#[derive(Clone, Debug, Default)]
pub struct InputField {
    pub label: String,
    input: Input,
    /// True if the whole text is marked. Typing then replaces it.
    is_marked: bool,
}

/// A few fields, with a title above and lines of text below.
#[derive(Clone, Debug, Default)]
pub struct InputForm {
    pub title: String,
    /// The fields, from top to bottom.
    pub fields: Vec<InputField>,
    /// Index of the selected field.
    pub selected: usize,
    /// The lines below the fields.
    pub info: Vec<String>,
    /// The reason why the form was refused. Typing removes it.
    pub complaint: Option<String>,
    /// The line about the keys that close the form.
    pub keys: &'static str,
}

impl InputField {
    pub fn new(label: &str, text: &str) -> Self {
        Self {
            label: label.to_owned(),
            input: Input::new(text.to_owned()),
            is_marked: !text.is_empty(),
        }
    }

    /// Creates the field `label` for a choice that is not typed. `text` is marked, and no cursor follows it.
    pub fn choice(label: &str, text: &str) -> Self {
        let field = Self::new(label, text);
        Self {
            input: field.input.with_cursor(0),
            ..field
        }
    }

    pub fn text(&self) -> &str {
        self.input.value()
    }

    /// Returns the number of code points before the cursor.
    pub fn cursor(&self) -> usize {
        self.input.cursor()
    }

    /// Returns true if the whole text is marked. Typing then replaces it.
    pub fn is_marked(&self) -> bool {
        self.is_marked
    }

    /// Inserts `typed` before the cursor. Ignores characters that would control a terminal.
    fn type_char(&mut self, typed: char) {
        if is_steering(typed) {
            return;
        }
        self.take_marked();
        if self.text().chars().count() < MOST_TYPED {
            self.input.handle(InputRequest::InsertChar(typed));
        }
    }

    /// Removes the text if it is marked. Returns true if it was.
    fn take_marked(&mut self) -> bool {
        let was_marked = std::mem::take(&mut self.is_marked);
        if was_marked {
            self.input.reset();
        }
        was_marked
    }
}

impl InputForm {
    /// Creates a form with `title` and `fields`, with the first field selected. `keys` is the line about the keys that
    /// close it.
    pub fn new(title: &str, fields: Vec<InputField>, keys: &'static str) -> Self {
        Self {
            title: title.to_owned(),
            fields,
            keys,
            ..Self::default()
        }
    }

    /// Returns the text of the field `index`, from 0; empty if there is no such field.
    pub fn text(&self, index: usize) -> &str {
        self.fields.get(index).map_or("", InputField::text)
    }

    /// Inserts the pasted `text` before the cursor as if it were typed. If it does not fit, the end is cut off and the
    /// form says so.
    pub fn paste(&mut self, text: &str) {
        let mut typed = text.chars().filter(|&c| !is_steering(c)).peekable();
        self.edit(|field| {
            while field.is_marked || field.text().chars().count() < MOST_TYPED {
                match typed.next() {
                    Some(c) => field.type_char(c),
                    None => break,
                }
            }
        });
        if typed.peek().is_some() {
            self.complaint = Some(format!(
                "a field takes at most {MOST_TYPED} characters: the pasted text is cut off"
            ));
        }
    }

    /// Marks the whole text of the selected field, so that typing replaces it.
    pub fn mark(&mut self) {
        self.move_cursor(InputRequest::GoToEnd);
        if let Some(field) = self.fields.get_mut(self.selected) {
            field.is_marked = !field.text().is_empty();
        }
    }

    /// Selects the field with the index `field`, if it exists.
    pub fn select(&mut self, field: usize) {
        if field < self.fields.len() {
            self.selected = field;
        }
    }

    /// Edits the selected field, moves its cursor, or selects another field. The order of the fields is circular.
    pub fn edit_field(&mut self, edit: FieldEdit) {
        let count = self.fields.len().max(1);
        match edit {
            FieldEdit::Type(typed) => self.edit(|field| field.type_char(typed)),
            FieldEdit::Erase => self.remove(InputRequest::DeletePrevChar),
            FieldEdit::Delete => self.remove(InputRequest::DeleteNextChar),
            FieldEdit::Clear => self.remove(InputRequest::DeleteLine),
            FieldEdit::Left => self.move_cursor(InputRequest::GoToPrevChar),
            FieldEdit::Right => self.move_cursor(InputRequest::GoToNextChar),
            FieldEdit::Home => self.move_cursor(InputRequest::GoToStart),
            FieldEdit::End => self.move_cursor(InputRequest::GoToEnd),
            FieldEdit::Next => self.selected = (self.selected + 1) % count,
            FieldEdit::Previous => self.selected = (self.selected + count - 1) % count,
        }
    }

    fn edit(&mut self, change: impl FnOnce(&mut InputField)) {
        self.complaint = None;
        if let Some(field) = self.fields.get_mut(self.selected) {
            change(field);
        }
    }

    /// Removes the text if it is marked, or else the part `what`.
    fn remove(&mut self, what: InputRequest) {
        self.edit(|field| {
            if !field.take_marked() {
                field.input.handle(what);
            }
        });
    }

    fn move_cursor(&mut self, to: InputRequest) {
        if let Some(field) = self.fields.get_mut(self.selected) {
            field.input.handle(to);
            field.is_marked = false;
        }
    }
}

/// Maximum number of characters in a line without a cursor: a filter or a search.
const MOST_IN_LINE: usize = 100;

/// Appends `text` to the line `typed`, without control characters, up to 100 characters.
pub(super) fn type_into(typed: &mut String, text: &str) {
    let room = MOST_IN_LINE.saturating_sub(typed.chars().count());
    let characters = text.chars().filter(|&c| !is_steering(c));
    typed.extend(characters.take(room));
}

/// Edits `line`, which has no cursor. Ignores edits that move a cursor.
pub fn edit_line(line: &mut String, edit: FieldEdit) {
    match edit {
        FieldEdit::Type(typed) => type_into(line, typed.encode_utf8(&mut [0; 4])),
        FieldEdit::Erase => drop(line.pop()),
        FieldEdit::Clear => line.clear(),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use FieldEdit::{Clear, Delete, End, Erase, Home, Left, Next, Previous, Right, Type};
    use proptest::prelude::*;

    fn form(text: &str) -> InputForm {
        let fields = vec![InputField::new("a", text), InputField::new("b", "")];
        InputForm::new("test", fields, "Esc")
    }

    /// Returns the edit for a character of the tests: an editing key, or typing the character.
    fn edit(key: char) -> FieldEdit {
        match key {
            '«' => Home,
            '»' => End,
            '←' => Left,
            '→' => Right,
            '↓' => Next,
            '↑' => Previous,
            '⌫' => Erase,
            '⌦' => Delete,
            '∅' => Clear,
            typed => Type(typed),
        }
    }

    #[test]
    fn keys_edit_the_selected_field() {
        for (text, keys, edited, cursor) in [
            // Typing inserts at the cursor.
            ("0.1", "»5←←⌫", ["015", ""], 1),
            ("0.1", "»5←←⌫«⌦速»ü", ["速15ü", ""], 4),
            ("速15ü", "»⌫⌫⌫⌫⌫⌦", ["", ""], 0),
            ("", "∅", ["", ""], 0),
            // A character of several code points is deleted as a whole.
            ("e\u{301}x", "←←", ["e\u{301}x", ""], 0),
            ("e\u{301}x", "←←⌦", ["x", ""], 0),
            // Typing replaces the suggested text, unless the cursor was moved.
            ("45", "30", ["30", ""], 2),
            ("45", "⌫", ["", ""], 0),
            ("45", "←.", ["4.5", ""], 2),
            // The order of the fields is circular.
            ("x", "»↓y↓z↑!", ["xz", "y!"], 2),
            // Characters that control a terminal are ignored.
            ("", "\u{1b}\n\t\u{7f}\u{9b}\u{202e}\u{2066}", ["", ""], 0),
            ("", "\\\"é速", ["\\\"é速", ""], 4),
        ] {
            let mut form = form(text);
            keys.chars().for_each(|key| form.edit_field(edit(key)));
            assert_eq!([form.text(0), form.text(1)], edited, "{text} {keys}");
            assert_eq!(form.fields[form.selected].cursor(), cursor, "{text} {keys}");
            assert_eq!(form.text(7), "");
        }
        let mut none = InputForm::default();
        "↓↑a".chars().for_each(|key| none.edit_field(edit(key)));
        assert_eq!(none.text(0), "");
    }

    #[test]
    fn the_next_change_clears_the_error_message() {
        let mut form = form("x");
        form.complaint = Some("no".to_owned());
        form.edit_field(Left);
        form.edit_field(Next);
        assert!(form.complaint.is_some());
        form.edit_field(Type('1'));
        assert_eq!(form.complaint, None);
    }

    proptest! {
        #[test]
        fn any_typed_keys_keep_a_valid_cursor(keys in prop::collection::vec((0..10_usize, any::<char>()), 0..60)) {
            let mut form = form("速 top");
            for (key, c) in keys {
                let edits = [Erase, Delete, Left, Right, Home, End, Next];
                form.edit_field(edits.get(key).copied().unwrap_or(Type(c)));
                let field = &form.fields[form.selected];
                prop_assert!(field.cursor() <= field.text().chars().count());
            }
        }
    }

    #[test]
    fn a_line_holds_at_most_100_characters_without_controls() {
        let mut line = "速".to_owned();
        type_into(&mut line, "a\n\u{1b}b");
        assert_eq!(line, "速ab");
        type_into(&mut line, &"x".repeat(MOST_IN_LINE));
        assert_eq!(line.chars().count(), MOST_IN_LINE);
    }
}
