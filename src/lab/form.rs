//! A small dialog of a few fields to type into.

use crate::scenario::problem::is_steering;

/// Characters a field holds at most.
const MOST_TYPED: usize = 1000;

/// One line to type into.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Field {
    /// What is asked for.
    pub label: String,
    /// What is typed so far.
    pub text: String,
    /// How many characters stand before the cursor.
    pub cursor: usize,
    /// Whether the whole text is marked, as it was put there: what is typed takes its place.
    pub is_marked: bool,
}

/// A few fields, and what there is to say about them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Form {
    /// What it is about.
    pub title: String,
    /// Its fields, from above.
    pub fields: Vec<Field>,
    /// The number of the field that is typed into.
    pub selected: usize,
    /// What is known about what is typed.
    pub info: Vec<String>,
    /// Why it was refused; typing takes it away.
    pub complaint: Option<String>,
    /// The keys that end it.
    pub keys: &'static str,
}

impl Field {
    /// The field of `label` with `text` in it, all of it marked.
    pub fn new(label: &str, text: &str) -> Self {
        Self {
            label: label.to_owned(),
            text: text.to_owned(),
            cursor: text.chars().count(),
            is_marked: !text.is_empty(),
        }
    }

    fn length(&self) -> usize {
        self.text.chars().count()
    }

    /// Where in the text the `index`th character begins, in bytes.
    fn byte(&self, index: usize) -> usize {
        let mut begins = self.text.char_indices().map(|(byte, _)| byte);
        begins.nth(index).unwrap_or(self.text.len())
    }

    fn type_char(&mut self, typed: char) {
        if is_steering(typed) {
            return;
        }
        self.take_marked();
        if self.length() >= MOST_TYPED {
            return;
        }
        let at = self.cursor.min(self.length());
        self.text.insert(self.byte(at), typed);
        self.cursor = at + 1;
    }

    /// Takes the text away if it is marked; gives whether it did.
    fn take_marked(&mut self) -> bool {
        let was_marked = std::mem::take(&mut self.is_marked);
        if was_marked {
            (self.text, self.cursor) = (String::new(), 0);
        }
        was_marked
    }

    /// Takes the `index`th character away, if there is one.
    fn take(&mut self, index: usize) {
        let (begin, end) = (self.byte(index), self.byte(index + 1));
        self.text.replace_range(begin..end, "");
    }
}

impl Form {
    /// An empty form of `title` with `fields`, the first of them selected; `keys` says how it ends.
    pub fn new(title: &str, fields: Vec<Field>, keys: &'static str) -> Self {
        Self {
            title: title.to_owned(),
            fields,
            keys,
            ..Self::default()
        }
    }

    /// What stands in the `index`th field; nothing where there is none.
    pub fn text(&self, index: usize) -> &str {
        self.fields.get(index).map_or("", |field| &field.text)
    }

    /// Puts `typed` before the cursor; characters that would steer a terminal are refused.
    pub fn type_char(&mut self, typed: char) {
        self.edit(|field| field.type_char(typed));
    }

    /// Takes the character before the cursor away.
    pub fn erase(&mut self) {
        self.edit(|field| {
            if field.take_marked() {
                return;
            }
            if let Some(before) = field.cursor.checked_sub(1) {
                field.take(before);
                field.cursor = before;
            }
        });
    }

    /// Takes the character at the cursor away.
    pub fn delete(&mut self) {
        self.edit(|field| {
            if !field.take_marked() {
                field.take(field.cursor);
            }
        });
    }

    /// Takes the whole of the field away.
    pub fn clear(&mut self) {
        self.edit(|field| {
            field.is_marked = true;
            field.take_marked();
        });
    }

    /// Marks the whole of the field: what is typed takes its place.
    pub fn mark(&mut self) {
        if let Some(field) = self.fields.get_mut(self.selected) {
            field.is_marked = !field.text.is_empty();
            field.cursor = field.length();
        }
    }

    /// The cursor one character to the left.
    pub fn left(&mut self) {
        self.move_cursor(|field| field.cursor.saturating_sub(1));
    }

    /// The cursor one character to the right.
    pub fn right(&mut self) {
        self.move_cursor(|field| field.cursor + 1);
    }

    /// The cursor to the beginning.
    pub fn home(&mut self) {
        self.move_cursor(|_| 0);
    }

    /// The cursor to the end.
    pub fn end(&mut self) {
        self.move_cursor(Field::length);
    }

    /// The field below; after the last the first.
    pub fn next_field(&mut self) {
        self.select(1);
    }

    /// The field above; before the first the last.
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

    fn move_cursor(&mut self, to: impl FnOnce(&Field) -> usize) {
        if let Some(field) = self.fields.get_mut(self.selected) {
            field.cursor = to(field).min(field.length());
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
        assert_eq!((form.text(0), form.fields[0].cursor), ("", 0));
        form.clear();
        assert_eq!(form.text(7), "");
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
                prop_assert!(field.cursor <= field.text.chars().count());
            }
        }
    }
}
