//! Pages as SVG, PDF and PNG: the contents of the files, their agreement, and hostile text.

use crate::support::words::{has, has_all};
use gyrolab::engine::text::checksum::crc32;
use gyrolab::plot::ink::{BLACK, at, circle, pen};
use gyrolab::plot::scene::TextAnchor;
use gyrolab::plot::{
    Color, PageFormat, PageScene, Paint, Point, SceneItem, Segment, StrokeStyle, VectorPath,
    letters, write,
};

const HOSTILE: &str =
    "</title><script>x</script> & \"q\" 'a' ]]> \u{0}\u{1b}[2J\u{202e}\u{ffff} 速い \\) (";
const RED: Color = Color([200, 30, 30]);

/// A page of 100 pt x 60 pt with a red disk, a clipped dashed line, a black square and a label.
fn page(title: &str, words: &str) -> PageScene {
    let mut scene = PageScene::new(100.0, 60.0, title);
    scene.fill(circle(at(20.0, 20.0), 10.0), RED);
    let dashed = StrokeStyle {
        dash_pt: vec![4.0, 2.0],
        ..pen(2.0, BLACK)
    };
    scene.items.push(SceneItem {
        path: VectorPath::polyline([at(0.0, 45.0), at(90.0, 45.0)]),
        paint: Paint::Stroke(dashed),
        clip: Some([at(10.0, 40.0), at(60.0, 50.0)]),
        words: None,
    });
    let corners = [(70.0, 10.0), (80.0, 10.0), (80.0, 20.0), (70.0, 20.0)];
    scene.fill(VectorPath::polygon(corners.map(|(x, y)| at(x, y))), BLACK);
    scene.write(
        &letters::escape(words),
        8.0,
        at(50.0, 58.0),
        TextAnchor::Middle,
    );
    scene
}

fn svg(scene: &PageScene) -> String {
    String::from_utf8(write(scene, PageFormat::Svg, None).unwrap()).unwrap()
}

/// Returns the uncompressed drawing operators of a PDF.
fn content(pdf: &[u8]) -> String {
    let find = |what: &[u8], from: usize| {
        let mut parts = pdf[from..].windows(what.len());
        parts.position(|part| part == what).unwrap() + from
    };
    let begin = find(b"\nstream\n", 0) + 8;
    let end = find(b"\nendstream", begin);
    let content = miniz_oxide::inflate::decompress_to_vec_zlib(&pdf[begin..end]).unwrap();
    String::from_utf8_lossy(&content).into_owned()
}

struct Picture {
    width: usize,
    height: usize,
    /// Red, green and blue of each pixel.
    dots: Vec<[u8; 3]>,
    dots_per_metre: u32,
}

impl Picture {
    fn of(bytes: &[u8]) -> Self {
        let decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        let mut reader = decoder.read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut data).unwrap();
        let step = frame.color_type.samples();
        let dots = data
            .chunks_exact(step)
            .map(|dot| [dot[0], dot[1 % step], dot[2 % step]]);
        let size = reader.info().pixel_dims.unwrap();
        assert_eq!((size.xppu, size.unit), (size.yppu, png::Unit::Meter));
        Self {
            width: frame.width as usize,
            height: frame.height as usize,
            dots: dots.collect(),
            dots_per_metre: size.xppu,
        }
    }

    /// Returns the pixel at a position on a page that is 100 pt wide.
    fn at(&self, x_pt: f64, y_pt: f64) -> [u8; 3] {
        let scale = 600.0 / 72.0;
        self.dots[(y_pt * scale) as usize * self.width + (x_pt * scale) as usize]
    }
}

#[test]
fn an_svg_has_a_paper_size_a_title_text_and_no_external_references() {
    let text = svg(&page("A title", "ab"));
    let document = roxmltree::Document::parse(&text).unwrap();
    let root = document.root_element();
    assert_eq!(root.attribute("width"), Some("35.28mm"));
    assert_eq!(root.attribute("height"), Some("21.17mm"));
    assert_eq!(root.attribute("viewBox"), Some("0 0 100 60"));
    let title = root.first_element_child().unwrap();
    assert_eq!(title.tag_name().name(), "title");
    assert_eq!(title.text(), Some("A title"));
    let with = |name: &str| {
        let mut nodes = root.descendants();
        nodes.find(|node| node.has_attribute(name)).unwrap()
    };
    let label = with("aria-label");
    assert_eq!(label.attribute("aria-label"), Some("ab"));
    let names = ["svg", "title", "g", "path", "clipPath"];
    for node in root.descendants().filter(roxmltree::Node::is_element) {
        assert!(names.contains(&node.tag_name().name()), "{node:?}");
        for attribute in node.attributes() {
            assert!(!attribute.name().starts_with("on") && !attribute.name().ends_with("href"));
        }
    }
    let clip = with("clip-path");
    let reference = clip.attribute("clip-path").unwrap();
    let name = reference
        .strip_prefix("url(#")
        .unwrap()
        .strip_suffix(')')
        .unwrap();
    let with_value = |attribute: &str, value: &str| {
        let mut nodes = root.descendants();
        nodes
            .find(|node| node.attribute(attribute) == Some(value))
            .unwrap()
            .first_element_child()
            .unwrap()
    };
    let rectangle = with_value("id", name);
    assert_eq!(rectangle.attribute("d"), Some("M10 40H60V50H10z"));
    assert_eq!(clip.attribute("stroke-dasharray"), Some("4 2"));
    assert_eq!(clip.attribute("stroke-width"), Some("2"));
    let red = with_value("fill", "#c81e1e").attribute("d").unwrap();
    assert!(red.starts_with("M30 20c0 5.52"), "{red}");
}

/// Returns the points of an SVG path as computed by a reader.
fn places(data: &str) -> Vec<(f64, f64)> {
    let (mut at, mut start) = ((0.0, 0.0), (0.0, 0.0));
    let mut places = vec![];
    let mut rest = data;
    while !rest.is_empty() {
        let command = rest.chars().next().unwrap();
        let end = rest[1..]
            .find(|c: char| c.is_ascii_alphabetic())
            .map_or(rest.len(), |end| end + 1);
        let numbers: Vec<f64> = rest[1..end]
            .replace('-', " -")
            .split_whitespace()
            .map(|n| n.parse().unwrap())
            .collect();
        rest = &rest[end..];
        let size = match command {
            'h' | 'v' | 'z' => 1,
            'M' | 'l' => 2,
            'q' => 4,
            'c' => 6,
            other => panic!("{other}"),
        };
        assert_eq!(numbers.len() % size, 0);
        for step in numbers.chunks(size) {
            let from = if command == 'M' { (0.0, 0.0) } else { at };
            let steps: Vec<(f64, f64)> = match command {
                'h' => vec![(step[0], 0.0)],
                'v' => vec![(0.0, step[0])],
                _ => step.chunks(2).map(|pair| (pair[0], pair[1])).collect(),
            };
            places.extend(steps.iter().map(|by| (from.0 + by.0, from.1 + by.1)));
            at = *places.last().unwrap();
        }
        match command {
            'M' => start = at,
            'z' => at = start,
            _ => {}
        }
    }
    places
}

#[test]
fn svg_coordinates_equal_those_of_the_page() {
    let corners = [
        at(0.0, 0.0),
        at(10.004, 0.0),
        at(10.0, -0.006),
        at(-3.25, 7.5),
        at(-3.25, 7.4),
        at(1e4, -1e4),
    ];
    let mut path = VectorPath::polygon(corners);
    path.0.push(Segment::Line(at(1.0, 1.0)));
    let quadratic = Segment::Quadratic(at(5.0, 5.125), at(-6.07, 0.5));
    let cubic = Segment::Cubic(at(5.0, 5.12), at(-6.0, 0.0), at(0.0, 0.0));
    path.0.extend([quadratic, cubic]);
    let rounded = |x: f64| (x * 100.0).round() / 100.0;
    let expected: Vec<_> = path
        .points()
        .map(|p| (rounded(p.x), rounded(p.y)))
        .collect();
    let mut scene = PageScene::new(10.0, 10.0, "");
    scene.fill(path, RED);
    let text = svg(&scene);
    let (_, data) = text.rsplit_once("d=\"").unwrap();
    let (data, _) = data.split_once('"').unwrap();
    let found = places(data);
    assert_eq!(found.len(), expected.len(), "{data}");
    for (place, wanted) in found.iter().zip(&expected) {
        assert!((place.0 - wanted.0).abs() < 1e-6, "{data}");
        assert!((place.1 - wanted.1).abs() < 1e-6, "{data}");
    }
}

#[test]
fn a_pdf_strokes_clips_and_embeds_its_font() {
    let pdf = write(&page("A title", "ab"), PageFormat::Pdf, None).unwrap();
    let text = String::from_utf8_lossy(&pdf);
    assert!(text.starts_with("%PDF-1.4"));
    assert!(text.contains("/MediaBox [0 0 100 60]"));
    assert!(text.contains("/Title (A title)"));
    for absent in ["/CreationDate", "/ModDate", "/ID", "/Type3", "/Helvetica"] {
        assert!(!text.contains(absent), "{absent}");
    }
    let drawing = content(&pdf);
    let lines: Vec<&str> = drawing.lines().collect();
    assert_eq!(lines[0], "1 0 0 -1 0 60 cm");
    let dashed = "q\n10 40 50 10 re\nW\nn\n0 G\n2 w\n[4 2] 0 d\n0 45 m\n90 45 l\nS\nQ\n";
    assert!(drawing.contains(dashed), "{drawing}");
    has(
        &drawing,
        "0.784 0.118 0.118 rg\n30 20 m\n30 25.52 25.52 30 20 30 c\n",
    );
    has(&drawing, "70 10 m\n80 10 l\n80 20 l\n70 20 l\nh\nf\n");
    has_all(&drawing, ["/Span <<", "/ActualText (ab)"]);
    // Two letters of an embedded font, upright on a page whose y axis points down.
    let shown = "/R 8 Tf\n1 0 0 -1 ";
    assert!(drawing.contains(shown), "{drawing}");
    has_all(&text, ["/CIDFontType2", "/FontFile2", "/ToUnicode"]);
    has(&text, "+STIXTwoText-Regular");
    assert!(!text.contains("STIXTwoText-Italic"));
    let [begins, ends] = [" BDC", "EMC"].map(|mark| drawing.matches(mark).count());
    assert_eq!(begins, ends);
}

#[test]
fn a_png_has_the_pixels_of_the_page() {
    let picture = Picture::of(&write(&page("A title", "ab"), PageFormat::Png, None).unwrap());
    // 100 pt x 60 pt at 600 dots an inch.
    assert_eq!((picture.width, picture.height), (834, 500));
    assert_eq!(picture.dots_per_metre, 23622);
    let (white, black, red) = ([255; 3], [0; 3], [200, 30, 30]);
    for (x, y, color) in [
        (20.0, 20.0, red),
        (20.0, 10.4, red),
        (20.0, 9.6, white),
        (5.0, 45.0, white),  // cut off
        (11.0, 45.0, white), // between two dashes
        (12.5, 45.0, black),
        (12.5, 43.6, white),
        (12.5, 44.2, black),
        (61.0, 45.0, white),
        (75.0, 15.0, black),
        (81.0, 15.0, white),
    ] {
        assert_eq!(picture.at(x, y), color, "{x} {y}");
    }
    let in_label = (480..760)
        .flat_map(|x| (540..600).map(move |y| (f64::from(x) / 10.0 - 10.0, f64::from(y) / 10.0)));
    assert!(
        in_label
            .filter(|(x, y)| picture.at(*x, *y) == black)
            .count()
            > 100
    );
    let grey = PageScene::new(10.0, 10.0, "");
    let bytes = write(&grey, PageFormat::Png, None).unwrap();
    assert_eq!(bytes[25], 0, "a page without color is gray");
    assert!(Picture::of(&bytes).dots.iter().all(|dot| *dot == white));
}

#[test]
fn hostile_text_cannot_break_a_file() {
    let long = "<".repeat(100_000);
    for hostile in [HOSTILE, &long, "", "\\\\((("] {
        let scene = page(hostile, &hostile.chars().take(500).collect::<String>());
        let text = svg(&scene);
        let document = roxmltree::Document::parse(&text).unwrap();
        assert!(
            !document
                .descendants()
                .any(|node| node.tag_name().name() == "script")
        );
        assert!(!text.chars().any(|c| c.is_control() && c != '\n'));
        let title = document.root_element().first_element_child().unwrap();
        if hostile == HOSTILE {
            let shown = "</title><script>x</script> & \"q\" 'a' ]]> \\u{0}\\u{1b}[2J\\u{202e}\u{fffd} 速い \\) (";
            assert_eq!(title.text(), Some(shown));
        }
        let pdf = write(&scene, PageFormat::Pdf, None).unwrap();
        let drawing = content(&pdf);
        let is_whole = hostile.is_empty() || drawing.ends_with("EMC\nQ");
        assert!(is_whole, "{}", &drawing[drawing.len() - 40..]);
        let picture = Picture::of(&write(&scene, PageFormat::Png, None).unwrap());
        assert_eq!(picture.at(75.0, 15.0), [0; 3]);
    }
}

/// The checksums were computed on one machine; all others must reproduce them. The compression of PDF and PNG may change
/// with its crate, so only the uncompressed contents count.
#[test]
fn files_are_identical_on_every_machine() {
    let known = [
        (PageFormat::Svg, 2_219_561_319),
        (PageFormat::Pdf, 1_146_029_640),
    ];
    for (format, crc) in known {
        let bytes = write(&page("A title", "Äß Ω"), format, None).unwrap();
        assert_eq!(
            bytes,
            write(&page("A title", "Äß Ω"), format, None).unwrap()
        );
        let stable = if format == PageFormat::Pdf {
            content(&bytes).into_bytes()
        } else {
            bytes
        };
        assert_eq!(crc32(&stable), crc, "{format:?}");
    }
    let picture = Picture::of(&write(&page("A title", "Äß Ω"), PageFormat::Png, None).unwrap());
    let pixels = crc32(picture.dots.as_flattened());
    assert_eq!(pixels, 2_315_199_443);
}

#[test]
fn dash_patterns_of_odd_length_and_zero_length_are_drawn() {
    for dash_pt in [vec![5.0], vec![5.0, 0.0, 5.0], vec![0.0, 0.0], vec![0.001]] {
        let mut scene = PageScene::new(100.0, 20.0, "");
        let dashed = StrokeStyle {
            dash_pt: dash_pt.clone(),
            ..pen(4.0, BLACK)
        };
        let line = VectorPath::polyline([at(0.0, 10.0), at(100.0, 10.0)]);
        scene.stroke(line, dashed, None);
        let picture = Picture::of(&write(&scene, PageFormat::Png, None).unwrap());
        assert_eq!(picture.at(2.0, 10.0), [0; 3], "{dash_pt:?}");
        let is_gap = dash_pt == [5.0];
        assert_eq!(picture.at(7.0, 10.0) == [255; 3], is_gap, "{dash_pt:?}");
    }
}

#[test]
fn empty_paths_and_single_points_are_drawn_without_errors() {
    let mut scene = PageScene::new(10.0, 10.0, "");
    let alone: [Point; 1] = [at(5.0, 5.0)];
    for path in [
        VectorPath::default(),
        VectorPath::polyline(alone),
        VectorPath::polygon(alone),
    ] {
        scene.fill(path.clone(), BLACK);
        scene.stroke(path, pen(1.0, BLACK), None);
    }
    for format in [PageFormat::Svg, PageFormat::Pdf, PageFormat::Png] {
        write(&scene, format, None).unwrap();
    }
    roxmltree::Document::parse(&svg(&scene)).unwrap();
    assert!(!content(&write(&scene, PageFormat::Pdf, None).unwrap()).contains("\nf\nf\n"));
}
