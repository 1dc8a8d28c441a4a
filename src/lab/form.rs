//! A form: a few fields to type into.

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

    /// Removes the character at the cursor, or the marked text.
    pub fn delete(&mut self) {
        self.take(InputRequest::DeleteNextChar);
    }

    /// Removes the whole text of the field.
    pub fn clear(&mut self) {
        self.take(InputRequest::DeleteLine);
    }

    /// Marks the whole text of the field: typing then replaces it.
    pub fn mark(&mut self) {
        self.end();
        if let Some(field) = self.fields.get_mut(self.selected) {
            field.is_marked = !field.text().is_empty();
        }
    }

    /// Moves the cursor one character to the left.
    pub fn left(&mut self) {
        self.move_cursor(InputRequest::GoToPrevChar);
    }

    /// Moves the cursor one character to the right.
    pub fn right(&mut self) {
        self.move_cursor(InputRequest::GoToNextChar);
    }

    /// Moves the cursor to the beginning.
    pub fn home(&mut self) {
        self.move_cursor(InputRequest::GoToStart);
    }

    pub fn end(&mut self) {
        self.move_cursor(InputRequest::GoToEnd);
    }

    /// Selects the field below; after the last, the first.
    pub fn next_field(&mut self) {
        self.select(1);
    }

    /// Selects the field above; before the first, the last.
    pub fn previous_field(&mut self) {
        self.select(self.fields.len().saturating_sub(1));
    }

    fn select(&mut self, further: usize) {
        let count = self.fields.len().max(1);
        self.selected = (self.selected + further) % count;
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
        form.end();
        form.type_char('5');
        form.left();
        form.left();
        form.erase();
        assert_eq!(form.text(0), "015");
        form.home();
        form.delete();
        form.type_char('速');
        form.end();
        form.type_char('ü');
        assert_eq!(form.text(0), "速15ü");
        form.erase();
        form.erase();
        form.erase();
        form.erase();
        form.erase();
        form.delete();
        assert_eq!((form.text(0), form.fields[0].cursor()), ("", 0));
        form.clear();
        assert_eq!(form.text(7), "");
    }

    #[test]
    fn a_character_of_several_code_points_goes_at_once() {
        let mut form = form("e\u{301}x");
        form.left();
        form.left();
        assert_eq!(form.fields[0].cursor(), 0);
        form.delete();
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
        moved.left();
        moved.type_char('.');
        assert_eq!(moved.text(0), "4.5");
    }

    #[test]
    fn fields_follow_one_another_in_a_ring() {
        let mut form = form("x");
        form.end();
        form.next_field();
        form.type_char('y');
        form.next_field();
        form.type_char('z');
        form.previous_field();
        form.type_char('!');
        assert_eq!((form.text(0), form.text(1)), ("xz", "y!"));
        let mut none = Form::default();
        none.next_field();
        none.previous_field();
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
        form.left();
        form.next_field();
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
                    1 => form.delete(),
                    2 => form.left(),
                    3 => form.right(),
                    4 => form.home(),
                    5 => form.end(),
                    6 => form.next_field(),
                    _ => form.type_char(c),
                }
                let field = &form.fields[form.selected];
                prop_assert!(field.cursor() <= field.text().chars().count());
            }
        }
    }
}
