//! A form: a few fields to type into.

use super::action::FieldEdit;
use crate::text::printable::is_steering;
use tui_input::{Input, InputRequest};

/// Characters a field holds at most.
const MOST_TYPED: usize = 1000;

/// One line to type into. The cursor moves by visible characters, each of which may consist of several code points.
#[derive(Clone, Debug, Default)]
pub struct Field {
    pub label: String,
    input: Input,
    /// Whether the whole text is marked: typing then replaces it.
    is_marked: bool,
}

/// A few fields, with a title above and lines of text below.
#[derive(Clone, Debug, Default)]
pub struct Form {
    pub title: String,
    /// Its fields, from top to bottom.
    pub fields: Vec<Field>,
    /// The number of the field that is typed into.
    pub selected: usize,
    /// The lines below the fields.
    pub info: Vec<String>,
    /// Why the form was refused; typing removes it.
    pub complaint: Option<String>,
    /// The line about the keys that end it.
    pub keys: &'static str,
}

impl Field {
    pub fn new(label: &str, text: &str) -> Self {
        Self {
            label: label.to_owned(),
            input: Input::new(text.to_owned()),
            is_marked: !text.is_empty(),
        }
    }

    /// The field of `label` with a choice that is not typed: `text` is marked, and no cursor stands behind it.
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

    /// How many code points stand before the cursor.
    pub fn cursor(&self) -> usize {
        self.input.cursor()
    }

    /// Whether the whole text is marked: typing then replaces it.
    pub fn is_marked(&self) -> bool {
        self.is_marked
    }

    fn type_char(&mut self, typed: char) {
        if is_steering(typed) {
            return;
        }
        self.take_marked();
        if self.text().chars().count() < MOST_TYPED {
            self.input.handle(InputRequest::InsertChar(typed));
        }
    }

    /// Removes the text if it is marked; returns whether it did.
    fn take_marked(&mut self) -> bool {
        let was_marked = std::mem::take(&mut self.is_marked);
        if was_marked {
            self.input.reset();
        }
        was_marked
    }
}

impl Form {
    /// A form with `title` and `fields`, the first of them selected; `keys` is the line about the keys that end it.
    pub fn new(title: &str, fields: Vec<Field>, keys: &'static str) -> Self {
        Self {
            title: title.to_owned(),
            fields,
            keys,
            ..Self::default()
        }
    }

    /// The text of the field `index`, from 0; empty if there is no such field.
    pub fn text(&self, index: usize) -> &str {
        self.fields.get(index).map_or("", Field::text)
    }

    /// Inserts `typed` before the cursor. Characters that would control a terminal are refused.
    pub fn type_char(&mut self, typed: char) {
        self.edit(|field| field.type_char(typed));
    }

    /// Inserts the pasted `text` before the cursor as if it had been typed. If the field is too short for it, the end is
    /// cut and the form says so.
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
                "a field takes at most {MOST_TYPED} characters: what was pasted is cut"
            ));
        }
    }

    /// Removes the character before the cursor, or the marked text.
    pub fn erase(&mut self) {
        self.take(InputRequest::DeletePrevChar);
    }

    /// Marks the whole text of the field: typing then replaces it.
    pub fn mark(&mut self) {
        self.move_cursor(InputRequest::GoToEnd);
        if let Some(field) = self.fields.get_mut(self.selected) {
            field.is_marked = !field.text().is_empty();
        }
    }

    /// Changes or moves within the selected field, or selects another: after the last comes the first.
    pub fn edit_field(&mut self, edit: FieldEdit) {
        let count = self.fields.len().max(1);
        match edit {
            FieldEdit::Delete => self.take(InputRequest::DeleteNextChar),
            FieldEdit::Clear => self.take(InputRequest::DeleteLine),
            FieldEdit::Left => self.move_cursor(InputRequest::GoToPrevChar),
            FieldEdit::Right => self.move_cursor(InputRequest::GoToNextChar),
            FieldEdit::Home => self.move_cursor(InputRequest::GoToStart),
            FieldEdit::End => self.move_cursor(InputRequest::GoToEnd),
            FieldEdit::Next => self.selected = (self.selected + 1) % count,
            FieldEdit::Previous => self.selected = (self.selected + count - 1) % count,
        }
    }

    fn edit(&mut self, change: impl FnOnce(&mut Field)) {
        self.complaint = None;
        if let Some(field) = self.fields.get_mut(self.selected) {
            change(field);
        }
    }

    fn take(&mut self, what: InputRequest) {
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

/// The most characters of such a line.
pub(super) const MOST_IN_LINE: usize = 100;

/// Adds `text` to the line `typed`, without line ends and other control characters, up to 100 characters. Returns whether
/// all of it had room.
pub(super) fn type_into(typed: &mut String, text: &str) -> bool {
    let room = MOST_IN_LINE.saturating_sub(typed.chars().count());
    let mut characters = text.chars().filter(|&c| !is_steering(c));
    typed.extend(characters.by_ref().take(room));
    characters.next().is_none()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn form(text: &str) -> Form {
        Form::new(
            "test",
            vec![Field::new("a", text), Field::new("b", "")],
            "Esc",
        )
    }

    #[test]
    fn typing_goes_where_the_cursor_is() {
        let mut form = form("0.1");
        form.edit_field(FieldEdit::End);
        form.type_char('5');
        form.edit_field(FieldEdit::Left);
        form.edit_field(FieldEdit::Left);
        form.erase();
        assert_eq!(form.text(0), "015");
        form.edit_field(FieldEdit::Home);
        form.edit_field(FieldEdit::Delete);
        form.type_char('速');
        form.edit_field(FieldEdit::End);
        form.type_char('ü');
        assert_eq!(form.text(0), "速15ü");
        form.erase();
        form.erase();
        form.erase();
        form.erase();
        form.erase();
        form.edit_field(FieldEdit::Delete);
        assert_eq!((form.text(0), form.fields[0].cursor()), ("", 0));
        form.edit_field(FieldEdit::Clear);
        assert_eq!(form.text(7), "");
    }

    #[test]
    fn a_character_of_several_code_points_goes_at_once() {
        let mut form = form("e\u{301}x");
        form.edit_field(FieldEdit::Left);
        form.edit_field(FieldEdit::Left);
        assert_eq!(form.fields[0].cursor(), 0);
        form.edit_field(FieldEdit::Delete);
        assert_eq!(form.text(0), "x");
    }

    #[test]
    fn what_is_typed_takes_the_place_of_what_was_there_unless_the_cursor_was_moved() {
        let mut typed = form("45");
        "30".chars().for_each(|c| typed.type_char(c));
        assert_eq!(typed.text(0), "30");
        let mut erased = form("45");
        erased.erase();
        assert_eq!(erased.text(0), "");
        let mut moved = form("45");
        moved.edit_field(FieldEdit::Left);
        moved.type_char('.');
        assert_eq!(moved.text(0), "4.5");
    }

    #[test]
    fn fields_follow_one_another_in_a_ring() {
        let mut form = form("x");
        form.edit_field(FieldEdit::End);
        form.edit_field(FieldEdit::Next);
        form.type_char('y');
        form.edit_field(FieldEdit::Next);
        form.type_char('z');
        form.edit_field(FieldEdit::Previous);
        form.type_char('!');
        assert_eq!((form.text(0), form.text(1)), ("xz", "y!"));
        let mut none = Form::default();
        none.edit_field(FieldEdit::Next);
        none.edit_field(FieldEdit::Previous);
        none.type_char('a');
        assert_eq!(none.text(0), "");
    }

    #[test]
    fn what_steers_a_terminal_is_refused() {
        let mut form = form("");
        for c in [
            '\u{1b}', '\n', '\t', '\u{7f}', '\u{9b}', '\u{202e}', '\u{2066}',
        ] {
            form.type_char(c);
        }
        assert_eq!(form.text(0), "");
        for c in ['\\', '"', 'é', '速'] {
            form.type_char(c);
        }
        assert_eq!(form.text(0), "\\\"é速");
    }

    #[test]
    fn a_complaint_goes_with_the_next_change() {
        let mut form = form("x");
        form.complaint = Some("no".to_owned());
        form.edit_field(FieldEdit::Left);
        form.edit_field(FieldEdit::Next);
        assert!(form.complaint.is_some());
        form.type_char('1');
        assert_eq!(form.complaint, None);
    }

    proptest! {
        #[test]
        fn nothing_typed_breaks_it(keys in prop::collection::vec((0..10u8, any::<char>()), 0..60)) {
            let mut form = form("速 top");
            for (key, c) in keys {
                match key {
                    0 => form.erase(),
                    1 => form.edit_field(FieldEdit::Delete),
                    2 => form.edit_field(FieldEdit::Left),
                    3 => form.edit_field(FieldEdit::Right),
                    4 => form.edit_field(FieldEdit::Home),
                    5 => form.edit_field(FieldEdit::End),
                    6 => form.edit_field(FieldEdit::Next),
                    _ => form.type_char(c),
                }
                let field = &form.fields[form.selected];
                prop_assert!(field.cursor() <= field.text().chars().count());
            }
        }
    }

    #[test]
    fn a_line_takes_a_hundred_characters_and_none_that_steer() {
        let mut line = "速".to_owned();
        assert!(type_into(&mut line, "a\n\u{1b}b"));
        assert_eq!(line, "速ab");
        assert!(type_into(&mut line, &"x".repeat(MOST_IN_LINE - 3)));
        assert!(!type_into(&mut line, "y"));
        assert!(type_into(&mut line, "\n"), "nothing of it had no room");
        assert_eq!(line.chars().count(), MOST_IN_LINE);
    }
}
