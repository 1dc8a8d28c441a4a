//! Formulas in ASCII, for terminals whose locale is not UTF-8: `0.8²` becomes `0.8^2`, `κ` becomes `kappa`.

/// Superscript and subscript digits and signs, each followed by its normal form.
const RAISED: &str = "⁰0¹1²2³3⁴4⁵5⁶6⁷7⁸8⁹9⁻-⁺+ᵀT";
const LOWERED: &str = "₀0₁1₂2₃3₄4₅5₆6₇7₈8₉9";

const ASCII_WORDS: [(char, &str); 38] = [
    ('α', "alpha"),
    ('β', "beta"),
    ('ε', "eps"),
    ('θ', "theta"),
    ('κ', "kappa"),
    ('π', "pi"),
    ('τ', "tau"),
    ('φ', "phi"),
    ('χ', "chi"),
    ('ψ', "psi"),
    ('ω', "omega"),
    ('Δ', "Delta"),
    ('Σ', "Sum"),
    ('Ω', "Omega"),
    ('µ', "u"),
    ('μ', "u"),
    ('√', "sqrt"),
    ('½', "1/2"),
    ('×', "x"),
    ('·', "*"),
    ('±', "+-"),
    ('≈', "~"),
    ('≤', "<="),
    ('≥', ">="),
    ('−', "-"),
    ('–', "-"),
    ('—', "-"),
    ('°', " deg"),
    ('…', "..."),
    ('′', "'"),
    ('“', "\""),
    ('”', "\""),
    ('’', "'"),
    ('→', "->"),
    ('←', "<-"),
    ('═', "="),
    ('ö', "oe"),
    ('ü', "ue"),
];

/// Returns the normal form of `c` in `pairs`.
fn on_line(pairs: &str, c: char) -> Option<char> {
    let mut all = pairs.chars();
    all.find(|other| *other == c).and_then(|_| all.next())
}

/// Replaces each character of `text` that is not ASCII by its meaning. Characters without a known meaning stay.
pub fn in_ascii(text: &str) -> String {
    let mut ascii = String::with_capacity(text.len() + 16);
    let mut sign = ' ';
    for c in text.chars() {
        let found = [('^', RAISED), ('_', LOWERED)]
            .into_iter()
            .find_map(|(mark, pairs)| Some((mark, on_line(pairs, c)?)));
        if let Some((new, plain)) = found.filter(|_| !c.is_ascii()) {
            if new != sign {
                ascii.push(new);
            }
            ascii.push(plain);
            sign = new;
            continue;
        }
        sign = ' ';
        match ASCII_WORDS.iter().find(|(known, _)| *known == c) {
            // Two names of quantities in a row are a product.
            Some((_, word))
                if word.len() > 1
                    && ascii.ends_with(char::is_alphanumeric)
                    && c.is_alphabetic() =>
            {
                ascii.push(' ');
                ascii.push_str(word);
            }
            Some((_, word)) => ascii.push_str(word),
            None => ascii.push(c),
        }
    }
    ascii
}

#[cfg(test)]
mod tests {
    use super::in_ascii;

    #[test]
    fn formulas_keep_their_meaning() {
        for (text, ascii) in [
            ("10 × 0.5 × 0.8²", "10 x 0.5 x 0.8^2"),
            ("L₃² > 4 I₁ mgl", "L_3^2 > 4 I_1 mgl"),
            ("10⁻¹² J s", "10^-12 J s"),
            ("2κ(1 − κ)(1 − cos ψ)", "2 kappa(1 - kappa)(1 - cos psi)"),
            ("|Ω| dt, Ω = I⁻¹ L", "|Omega| dt, Omega = I^-1 L"),
            ("2π/ω₃", "2 pi/omega_3"),
            ("τ = −g Σ m y", "tau = -g Sum m y"),
            ("3 µm, 速", "3 um, 速"),
        ] {
            assert_eq!(in_ascii(text), ascii);
        }
    }
}
