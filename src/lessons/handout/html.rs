//! A handout as one HTML file, which any browser prints on A4 or Letter. It is well-formed XML and needs no other file.

use super::figures::{Figure, PaperFigureKind};
use super::{BLANK, Head, Paper, Part, Question};
use crate::engine::text::printable::xml;
use crate::lessons::lesson::AnswerKind;
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd, html};

/// Style sheet. It sets no paper size, so that the printer's paper is used.
const STYLE: &str = include_str!("handout.css");
/// Placeholder next to a question whose answer is not a picture.
const ROOM: &str = "<figure class=\"frame\">\n<div class=\"room\"></div>\n\
    <figcaption>Room to sketch or to calculate.</figcaption>\n</figure>\n";

/// Returns the whole handout.
pub(super) fn written(head: &Head, parts: &[Part], paper: Paper) -> String {
    let mut body = format!("<h1>{}</h1>\n", xml(&head.title));
    body += &of_markdown(&head.about);
    if paper == Paper::Worksheet {
        body += "<p class=\"who\">Name <i></i> Seat <i></i> Date <i></i></p>\n";
    }
    for block in &head.introduction {
        body += &part(block);
    }
    for page in parts.chunk_by(|_, next| !matches!(next, Part::Heading(_))) {
        let is_whole = page.iter().any(|part| {
            !matches!(
                part,
                Part::Heading(_)
                    | Part::Text(_)
                    | Part::Shown(_)
                    | Part::Screen(_)
                    | Part::Figures(_)
            )
        });
        body += if is_whole {
            "<section class=\"whole\">\n"
        } else {
            "<section>\n"
        };
        for block in page {
            body += &part(block);
        }
        body += "</section>\n";
    }
    document(&head.title, &body)
}

/// Returns a complete HTML file of `markdown`, whose first heading is the title.
pub fn from_markdown(title: &str, markdown: &str) -> String {
    document(title, &of_markdown(markdown))
}

fn document(title: &str, body: &str) -> String {
    let title = xml(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width\"/>\n<title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n\
         <body>\n<main>\n{body}</main>\n</body>\n</html>\n"
    )
}

fn part(part: &Part) -> String {
    match part {
        Part::Heading(heading) => format!("<h2>{}</h2>\n", xml(heading)),
        Part::Text(text) => of_markdown(text),
        Part::Shown(code) => pre(&code.text),
        Part::Screen(text) => pre(text),
        Part::Figures(figures) => {
            let is_wide = figures.iter().any(|it| it.kind == PaperFigureKind::Table);
            let class = if is_wide { "column" } else { "row" };
            let all: String = figures.iter().map(figure).collect();
            format!("<div class=\"{class}\">\n{all}</div>\n")
        }
        Part::Question(asked) => question(asked),
        Part::Goals(goals) => {
            let items: String = goals.iter().map(|goal| tick(goal)).collect();
            format!("<ul class=\"ticks\">\n{items}</ul>\n")
        }
        Part::Compared => line("Predicted") + &line("Came out"),
        Part::Why => line("Why") + &line(""),
        Part::OwnWords => line("In your own words") + &line(""),
    }
}

/// Returns `text` with its line breaks.
fn pre(text: &str) -> String {
    let lines: Vec<_> = text.trim_end().lines().map(xml).collect();
    format!("<pre>{}</pre>\n", lines.join("\n"))
}

fn figure(figure: &Figure) -> String {
    let class = match figure.kind {
        PaperFigureKind::Chart => "chart",
        PaperFigureKind::Space => "space",
        PaperFigureKind::Table => "table",
        PaperFigureKind::Frame => "frame",
    };
    format!(
        "<figure class=\"{class}\">\n{}<figcaption>{}</figcaption>\n</figure>\n",
        figure.svg,
        xml(&figure.caption)
    )
}

fn tick(words: &str) -> String {
    format!("<li>{}</li>\n", xml(words))
}

/// Returns a line to write on, after `words`.
fn line(words: &str) -> String {
    format!("<p class=\"line\">{words}<i></i></p>\n")
}

fn question(question: &Question) -> String {
    let mut text = "<div class=\"question\">\n<h3>Your prediction</h3>\n".to_owned();
    text += "<div class=\"asked\">\n<div>\n";
    text += &of_markdown(&question.ask);
    text += &match &question.asked {
        AnswerKind::Choice(choices) => {
            let numbered = (1..).zip(choices);
            let items: String = numbered
                .map(|(number, choice)| tick(&format!("{number}\u{2002}{choice}")))
                .collect();
            format!("<ul class=\"ticks\">\n{items}</ul>\n")
        }
        AnswerKind::Number { unit } => {
            format!("<p class=\"number\">Answer <i></i> {}</p>\n", xml(unit))
        }
    };
    text += "</div>\n";
    if question.has_room {
        text += &question
            .frame
            .as_ref()
            .map_or_else(|| ROOM.to_owned(), figure);
    }
    text += "</div>\n";
    if question.has_room {
        text += &(line("Reason") + &line(""));
    }
    text + "</div>\n"
}

/// Returns `markdown` as HTML. HTML in it is shown as text. Links and pictures become plain words, because the file
/// must not need other files.
fn of_markdown(markdown: &str) -> String {
    let events = Parser::new_ext(markdown, Options::ENABLE_TABLES);
    let plain = events.filter_map(|event| match event {
        Event::Html(text) | Event::InlineHtml(text) => Some(Event::Text(text)),
        Event::Start(Tag::Link { .. } | Tag::Image { .. } | Tag::HtmlBlock)
        | Event::End(TagEnd::Link | TagEnd::Image | TagEnd::HtmlBlock) => None,
        other => Some(other),
    });
    let mut text = String::new();
    html::push_html(&mut text, plain);
    text.replace(BLANK, "<i class=\"blank\"></i>")
}
