//! Lessons on paper: worksheets, results and teacher's sheets, in Markdown and HTML.

use crate::lessons::{WHOLE, lab, lessons, on, read};
use crate::support::words::{has, has_all};
use gyrolab::lab::Lab;
use gyrolab::lessons::handout::{Handout, LabPictures, Paper, PaperFormat, html};
use gyrolab::lessons::lesson::Right;
use gyrolab::lessons::{AnswerKind, Lesson, LessonBlock, LessonPage, reading, shipped, teacher};
use gyrolab::tui::{screen, svg};
use roxmltree::{Document, Node, ParsingOptions};

fn screen_text(lab: &Lab) -> String {
    screen::text(lab, false, (80, 24))
}

fn written(lesson: &Lesson, paper: Paper, format: PaperFormat) -> String {
    let handout = Handout {
        lesson,
        paper,
        format,
        pictures: LabPictures {
            screen: screen_text,
            pane: |lab, pane| svg::pane(lab, pane, (72, 26)),
        },
    };
    handout.write(lab(), &mut on).unwrap()
}

fn parsed(html: &str) -> Document<'_> {
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(html, options).unwrap()
}

fn elements<'a>(node: Node<'a, 'a>, name: &'static str) -> impl Iterator<Item = Node<'a, 'a>> {
    node.descendants()
        .filter(move |node| node.tag_name().name() == name)
}

fn of_class<'a>(node: Node<'a, 'a>, class: &'static str) -> impl Iterator<Item = Node<'a, 'a>> {
    node.descendants()
        .filter(move |node| node.attribute("class") == Some(class))
}

fn text_of(node: Node<'_, '_>) -> String {
    node.descendants()
        .filter_map(|node| node.text().filter(|_| node.is_text()))
        .collect()
}

/// Returns, for each outcome of `lesson`, the longest text between numbers, without blanks and emphasis.
fn outcomes(lesson: &Lesson) -> Vec<String> {
    let compares = lesson.pages.iter().flat_map(LessonPage::compares);
    let texts = compares.map(|compare| compare.text.filled(|_, _| "@".to_owned()));
    texts
        .map(|text| {
            let longest = text.split('@').max_by_key(|words| words.len()).unwrap();
            longest.trim().to_owned()
        })
        .collect()
}

#[test]
fn a_worksheet_contains_all_questions_and_no_answers() {
    for lesson in lessons() {
        let sheet = written(&lesson, Paper::Worksheet, PaperFormat::Markdown);
        for page in &lesson.pages {
            let at = sheet.find(&format!("## {}\n", page.heading)).unwrap();
            let own = sheet[at + 3..].split("\n## ").next().unwrap();
            for predict in page.predicts() {
                let ask = predict.ask.filled(|_, _| "@".to_owned());
                has(own, ask.split('@').next().unwrap());
            }
            for block in &page.blocks {
                if let LessonBlock::Shown(shown) = block
                    && shown.language == "sh"
                {
                    has(own, &shown.text);
                }
            }
            assert!(
                own.contains("Came out: __") || page.compares().next().is_none(),
                "{own}"
            );
        }
        for words in outcomes(&lesson) {
            assert!(!sheet.contains(&words), "{}: {words}", lesson.name);
        }
    }
}

#[test]
fn results_have_pictures_and_outcomes_and_no_notes() {
    for lesson in lessons() {
        let paper = written(&lesson, Paper::Results, PaperFormat::Markdown);
        let headings: Vec<_> = paper
            .lines()
            .filter(|line| line.starts_with("## "))
            .collect();
        let pages: Vec<_> = lesson
            .pages
            .iter()
            .map(|page| format!("## {}", page.heading))
            .collect();
        assert_eq!(headings, pages);
        for words in outcomes(&lesson) {
            has(&paper, &words);
        }
        for notes in lesson.pages.iter().flat_map(LessonPage::notes) {
            let notes = notes.filled(|_, _| String::new());
            let first = notes.lines().next().unwrap();
            assert!(!paper.contains(first), "{}: {first}", lesson.name);
        }
        assert!(!paper.contains("```notes") && !paper.contains("```lab"));
    }
    let paper = written(&read(WHOLE), Paper::Results, PaperFormat::Markdown);
    has_all(
        &paper,
        [
            "# The push\n\nA push, and what the time step has to do with it. About 10 minutes.\n\nBefore the first page.\n\n## Watch\n\n```text\n",
            "**Prediction.** With a time step ten times shorter, the wobble ...\n\n- [ ] 1 stays as it is\n- [ ] 2 is ten times smaller\n- [ ] 3 is gone\n",
            ". You said: ____________.\n\n```sh\ngyrolab run wobble-push\n```\n\n## Your turn\n",
            "At 60 s the top is at z = **0.",
            "`{ code }` and \\{braces} stay.",
        ],
    );
    let begin = paper.find("## Watch").unwrap();
    let end = paper.find("**Prediction.**").unwrap();
    assert!(
        !paper[begin..end].contains("NOT RELIABLE"),
        "the health is hidden before the prediction"
    );
    assert!(paper[end..].contains("NOT RELIABLE"));
}

/// Checks that an HTML file needs no other file, that its headings are in order and its pictures have titles.
fn check_page(html: &str, lesson: &Lesson) {
    for outside in [
        "http://", "https://", "src=", "href=", "url(http", "@import",
    ] {
        let without_names = html.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
        assert!(
            !without_names.contains(outside),
            "{}: {outside}",
            lesson.name
        );
    }
    let document = parsed(html);
    let root = document.root_element();
    assert_eq!(root.attribute("lang"), Some("en"));
    assert_eq!(elements(root, "h1").count(), 1);
    let headings = root.descendants().filter_map(|node| {
        let level = node.tag_name().name().strip_prefix('h')?;
        level.parse::<u32>().ok()
    });
    let mut before = 0;
    for level in headings {
        assert!(
            level <= before + 1,
            "{}: h{level} after h{before}",
            lesson.name
        );
        before = level;
    }
    for picture in elements(root, "svg") {
        let title = elements(picture, "title").next().map(text_of);
        assert!(
            title.is_some_and(|title| !title.is_empty()),
            "{}",
            lesson.name
        );
    }
}

#[test]
fn a_worksheet_in_html_has_a_frame_for_each_prediction_and_no_outcome() {
    for lesson in lessons() {
        let html = written(&lesson, Paper::Worksheet, PaperFormat::Html);
        check_page(&html, &lesson);
        let document = parsed(&html);
        let root = document.root_element();
        has(&text_of(root), "Seat");
        let asked: Vec<_> = lesson.pages.iter().flat_map(LessonPage::predicts).collect();
        let questions: Vec<_> = of_class(root, "question").collect();
        assert_eq!(questions.len(), asked.len(), "{}", lesson.name);
        for (question, predict) in questions.iter().zip(asked) {
            let frame = of_class(*question, "frame").next().unwrap();
            let axes = elements(frame, "svg").count();
            assert_eq!(
                axes,
                usize::from(predict.draw.is_some()),
                "{}",
                predict.name
            );
            if let AnswerKind::Choice(choices) = &predict.asked {
                assert_eq!(elements(*question, "li").count(), choices.len());
            }
            has(&text_of(*question), "Reason");
        }
        let words = text_of(root);
        for outcome in outcomes(&lesson) {
            assert!(!words.contains(&outcome), "{}: {outcome}", lesson.name);
        }
        // Pages before the first question and pages with questions have pictures.
        let mut has_asked = false;
        for section in elements(root, "section") {
            let asks = of_class(section, "question").next().is_some();
            has_asked |= asks;
            let pictures = elements(section, "svg").count();
            assert!(
                asks || !has_asked || pictures == 0,
                "{}: {}",
                lesson.name,
                text_of(section)
            );
        }
    }
}

#[test]
fn results_in_html_have_a_figure_for_each_run() {
    for lesson in lessons() {
        let html = written(&lesson, Paper::Results, PaperFormat::Html);
        check_page(&html, &lesson);
        let document = parsed(&html);
        let sections = elements(document.root_element(), "section");
        for (section, page) in sections.zip(&lesson.pages) {
            let figures = elements(section, "figure").count();
            assert!(
                figures > 0 || !page.plays(),
                "{}: {}",
                lesson.name,
                page.heading
            );
            assert!(figures == 0 || page.lab().is_some());
        }
    }
}

#[test]
fn html_and_links_in_a_lesson_become_plain_text() {
    let html = html::from_markdown(
        "a < b",
        "# a\n\n<script>alert(1)</script> and [a link](https://example.org) ![a picture](x.png)\n\n<b>\n",
    );
    let document = parsed(&html);
    let root = document.root_element();
    for name in ["script", "a", "img", "b"] {
        assert_eq!(elements(root, name).count(), 0, "{name}");
    }
    has_all(&text_of(root), ["<script>alert(1)", "a link", "a picture"]);
    has_all(&html, ["<title>a &lt; b</title>"]);
}

#[test]
fn a_teachers_sheet_has_goals_minutes_answers_and_expectations() {
    for lesson in lessons() {
        let sheet = teacher::sheet(&lesson, lab(), &mut on).unwrap();
        let guide = &lesson.guide;
        for item in guide.goals.iter().chain(&guide.leaves_out) {
            has(&sheet, format!("- {item}\n"));
        }
        for (page, minutes) in lesson.pages.iter().zip(&guide.page_minutes) {
            let row = format!("| {} | {} | {minutes} |", page.number, page.heading);
            has(&sheet, row);
        }
        for predict in lesson.pages.iter().flat_map(LessonPage::predicts) {
            has_all(&sheet, [&predict.expected, &predict.explain]);
            if let (AnswerKind::Choice(choices), Some(Right::Choice(right))) =
                (&predict.asked, &predict.right)
            {
                has(
                    &sheet,
                    format!("{right}. **{}** (right)\n", choices[right - 1]),
                );
            }
        }
        for compare in lesson.pages.iter().flat_map(LessonPage::compares) {
            let text = compare.text.filled(|_, _| "@".to_owned());
            let mut sentences = text.split(". ");
            let told = sentences.find(|told| !told.contains("You ")).unwrap();
            has(&sheet, told.split('@').next().unwrap());
        }
        for notes in lesson.pages.iter().flat_map(LessonPage::notes) {
            let notes = notes.filled(|_, _| "@".to_owned());
            has(&sheet, notes.split('@').next().unwrap().trim());
        }
    }
}

#[test]
fn every_shipped_lesson_has_a_complete_guide_for_teachers() {
    let all: Vec<Lesson> = lessons();
    let shipped = &all[..shipped::LESSONS.len()];
    for (index, lesson) in shipped.iter().enumerate() {
        let (name, guide) = (&lesson.name, &lesson.guide);
        assert!(guide.level.is_some(), "{name}");
        assert!(guide.goals.len() >= 3, "{name}");
        assert!(!guide.leaves_out.is_empty(), "{name}");
        assert_eq!(guide.page_minutes.len(), lesson.pages.len(), "{name}");
        for predict in lesson.pages.iter().flat_map(LessonPage::predicts) {
            let texts = [&predict.expected, &predict.explain];
            assert!(texts.iter().all(|text| !text.is_empty()), "{name}");
        }
        // The list is a recommended order.
        let earlier: Vec<_> = shipped[..index].iter().map(|other| &other.name).collect();
        for need in &guide.needs {
            let is_lesson = all.iter().any(|other| other.name == *need);
            assert!(!is_lesson || earlier.contains(&need), "{name} needs {need}");
        }
    }
    assert!(shipped.is_sorted_by_key(|lesson| lesson.guide.level));
}

#[test]
fn teacher_keys_of_a_lesson_are_validated() {
    let head = "minutes = 10\n";
    let question = "name = \"finer\"\n";
    for (at, added, words) in [
        (
            head,
            "level = \"hard\"",
            "must be one of school, first year, mechanics course",
        ),
        (
            head,
            "page_minutes = [5, 5]",
            "has 2 numbers, and the lesson has 3 pages",
        ),
        (
            head,
            "page_minutes = [5, 5, 5]",
            "add up to 15, which must be the minutes of the lesson",
        ),
        (
            head,
            "page_minutes = [5, 5, \"\"]",
            "must be a list with a whole number of minutes",
        ),
        (head, "needs = \"paper\"", "lesson.needs"),
        (
            question,
            "draw = \"tilt\"",
            "must be above or a column of the CSV: did you mean tilt_deg?",
        ),
        (question, "expected = \"\"", "must not be empty"),
    ] {
        let text = WHOLE.replace(at, &format!("{at}{added}\n"));
        let problems = reading::read("a.md", &text).unwrap_err();
        has(&problems.to_string(), words);
    }
    let good = format!("{head}level = \"first year\"\npage_minutes = [1, 4, 5]\n");
    let lesson = read(&WHOLE.replace(head, &good));
    assert_eq!(lesson.guide.page_minutes, [1, 4, 5]);
}
