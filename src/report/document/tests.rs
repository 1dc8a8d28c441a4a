//! Both writers with arbitrary texts.

use super::*;
use proptest::prelude::*;
use pulldown_cmark::{Event, Options, Parser};

/// Returns the text that a reader of the Markdown sees.
fn seen(markdown: &str) -> String {
    let events = Parser::new_ext(markdown, Options::ENABLE_TABLES);
    events
        .filter_map(|event| match event {
            Event::Text(text) | Event::Code(text) => Some(text.to_string()),
            Event::SoftBreak => Some(" ".to_owned()),
            _ => None,
        })
        .collect()
}

/// True if braces and environments of the TeX file are balanced.
fn is_balanced(tex: &str) -> bool {
    let mut depth = 0_i64;
    let mut before = ' ';
    for c in tex.chars() {
        match c {
            '{' if before != '\\' => depth += 1,
            '}' if before != '\\' => depth -= 1,
            _ => {}
        }
        if depth < 0 {
            return false;
        }
        before = c;
    }
    depth == 0 && tex.matches("\\begin{").count() == tex.matches("\\end{").count()
}

proptest! {
    #[test]
    fn escaped_text_is_shown_literally(text in "[ -~é]{0,40}") {
        let mut document = Document::new(Text::plain("t"));
        document.paragraph(&escape(&text));
        let tex = document.tex();
        prop_assert!(is_balanced(&tex), "{}", tex);
        let markdown = document.markdown();
        let shown = seen(&markdown);
        let shown = shown.strip_prefix('t').unwrap();
        prop_assert_eq!(shown.trim(), text.trim(), "{}", markdown);
    }

    #[test]
    fn any_markup_gives_a_balanced_document(text in "[ -~éψ√\\n]{0,40}") {
        let mut document = Document::new(Text::plain(&text));
        document.paragraph(&text);
        document.formula(&text);
        document.list([&text]);
        document.code("sh", &text);
        document.table(&text, [Column::number(&text)], [[Text::marked(&text)], [Text::number(&text)]]);
        prop_assert!(is_balanced(&document.tex()), "{}", document.tex());
        prop_assert!(document.markdown().starts_with("# "));
    }
}

#[test]
fn figures_and_references_are_numbered_in_order() {
    let mut document = Document::new(Text::plain("t"));
    document.paragraph("See [#above], [#nothing] and [@jcgm].");
    document.figure("traces", 86.0, "First.");
    document.figure("above", 86.0, "Second, $κ = I_3/I_1$, at {9.8 m/s2}.");
    document.references.push(Reference {
        key: "jcgm",
        title: "Guide & more",
        year: "2008",
        ..Reference::default()
    });
    let markdown = document.markdown();
    assert!(
        markdown.contains("See Figure 2, nothing and [1]."),
        "{markdown}"
    );
    let caption = "**Figure 2.** Second, *κ* = *I*₃/*I*₁, at 9.8 m/s².";
    assert!(markdown.contains(caption), "{markdown}");
    let tex = document.tex();
    assert!(
        tex.contains(r"See Figure~\ref{above}, nothing and \cite{jcgm}."),
        "{tex}"
    );
    assert!(
        tex.contains(r"$\kappa = I_{3}/I_{1}$, at \SI{9.8}{m/s^2}."),
        "{tex}"
    );
    assert!(
        document
            .bibliography()
            .contains("title = {{Guide \\& more}}")
    );
}

#[test]
fn titles_are_escaped_for_tex() {
    let title = tex_text::escaped(r"100 % of \today & $x_1$ {#} ~^ --");
    let plain = r"100 \% of \textbackslash{}today \& \$x\_1\$ \{\#\} \textasciitilde{}\textasciicircum{} -{}-";
    assert_eq!(title, plain);
}
