//! The markup that users write in labels: `*t*` is slanted, `10^3^` has a superscript and `*Ω*_p_` a subscript. Braces are
//! allowed too, as in `x_{0}`, and a backslash makes the next character plain.

use super::escape;

/// Converts the markup of a user to the markup of [`label`](super::label). A sign without its partner is plain, and so is
/// one within a word: `run_1` and `my_run_2` have no subscript.
pub fn markup(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    converted(&letters, false)
}

fn converted(letters: &[char], is_script: bool) -> String {
    let mut markup = String::new();
    let mut rest = letters;
    while let [first, after @ ..] = rest {
        rest = after;
        match (first, after) {
            ('\\', [next, behind @ ..]) => {
                markup += &plain(*next);
                rest = behind;
            }
            ('*' | '_' | '^', _) => match Marked::find(*first, after) {
                Some(marked) => {
                    markup += &marked.converted(*first);
                    rest = marked.behind;
                }
                None => markup += &plain(*first),
            },
            ('-', [digit, ..]) if is_script && digit.is_ascii_digit() => markup.push('−'),
            _ => markup += &plain(*first),
        }
    }
    markup
}

/// Returns the markup of one plain character. A period is never made a decimal comma.
fn plain(letter: char) -> String {
    match letter {
        '.' => "\\.".to_owned(),
        letter => escape(&letter.to_string()),
    }
}

/// The text between a sign and its partner.
struct Marked<'a> {
    inner: &'a [char],
    behind: &'a [char],
}

impl<'a> Marked<'a> {
    /// Finds the text that `sign` marks; `after` is what follows the sign.
    fn find(sign: char, after: &'a [char]) -> Option<Self> {
        if let (false, ['{', inner @ ..]) = (sign == '*', after) {
            let length = inner.iter().position(|letter| *letter == '}')?;
            return Some(Self {
                inner: &inner[..length],
                behind: &inner[length + 1..],
            });
        }
        if after.first().is_none_or(|first| first.is_whitespace()) {
            return None;
        }
        let ends = |place: usize| {
            let is_in_word = after
                .get(place + 1)
                .is_some_and(|next| next.is_alphanumeric());
            after[place] == sign && !after[place - 1].is_whitespace() && !is_in_word
        };
        let length = (1..after.len()).find(|place| ends(*place))?;
        Some(Self {
            inner: &after[..length],
            behind: &after[length + 1..],
        })
    }

    fn converted(&self, sign: char) -> String {
        let inner = converted(self.inner, sign != '*');
        match sign {
            '*' => format!("*{inner}*"),
            sign => format!("{sign}{{{inner}}}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::letters::label;

    #[test]
    fn users_write_italics_and_scripts() {
        for (text, converted, words) in [
            ("*θ*_0_ = 20°", "*θ*_{0} = 20°", "θ₀ = 20°"),
            ("10^-3^ rad s^{-1}", "10^{−3} rad s^{−1}", "10⁻³ rad s⁻¹"),
            ("*ω*_3,0_ (rad/s)", "*ω*_{3,0} (rad/s)", "ω_(3,0) (rad/s)"),
            ("run_1", "run\\_1", "run_1"),
            ("my_run_2", "my\\_run\\_2", "my_run_2"),
            (
                "2*3*4 and 5 * 6",
                "2\\*3\\*4 and 5 \\* 6",
                "2*3*4 and 5 * 6",
            ),
            ("a\\_b_ c\\", "a\\_b\\_ c\\\\", "a_b_ c\\"),
            ("{x} 1.5", "\\{x\\} 1\\.5", "{x} 1.5"),
            ("*", "\\*", "*"),
            ("**", "\\*\\*", "**"),
        ] {
            assert_eq!(markup(text), converted, "{text}");
            assert_eq!(label(&markup(text), 8.0).words, words, "{text}");
        }
    }
}
