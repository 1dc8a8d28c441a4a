use super::*;
use proptest::prelude::*;

/// Decodes `pieces`, which arrive 1 ms apart.
fn typed(pieces: &[&[u8]]) -> Vec<Typed> {
    let (mut decoder, begin) = (Decoder::default(), Instant::now());
    for (piece, number) in pieces.iter().zip(0..) {
        decoder.feed(piece, begin + Duration::from_millis(number));
    }
    all(&mut decoder)
}

fn all(decoder: &mut Decoder) -> Vec<Typed> {
    std::iter::from_fn(|| decoder.take_typed()).collect()
}

/// Returns a decoder that was fed `bytes`, and the time.
fn fed(bytes: &[u8]) -> (Decoder, Instant) {
    let (mut decoder, begin) = (Decoder::default(), Instant::now());
    decoder.feed(bytes, begin);
    (decoder, begin)
}

/// Asserts that `text` decodes to `wanted` as a whole, cut anywhere, byte by byte, and twice before another key.
fn assert_decodes_to(text: &str, wanted: &Typed) {
    let (bytes, once) = (text.as_bytes(), [wanted.clone()]);
    for cut in 0..bytes.len() {
        let (begin, end) = bytes.split_at(cut);
        assert_eq!(typed(&[begin, end]), once, "{text:?} cut at {cut}");
    }
    let pieces: Vec<_> = bytes.chunks(1).collect();
    assert_eq!(typed(&pieces), once, "{text:?} byte by byte");
    let twice = [bytes, bytes, b"x"].concat();
    let thrice = [wanted.clone(), wanted.clone(), Typed::Key(Key::Char('x'))];
    assert_eq!(typed(&[&twice]), thrice, "{text:?} twice");
}

fn keys(keys: &[Key]) -> Vec<Typed> {
    keys.iter().copied().map(Typed::Key).collect()
}

#[test]
fn decodes_every_key_however_its_bytes_are_split() {
    use Key::*;
    let cases: &[(Key, &[&str])] = &[
        (Char('a'), &["a"]),
        (Char(' '), &[" "]),
        (Char('ü'), &["ü", "\u{1b}[252u"]),
        (Char('速'), &["速"]),
        (Char('🎡'), &["🎡"]),
        (Enter, &["\r", "\u{1b}[13;5u"]),
        (Ctrl('j'), &["\n"]),
        (Tab, &["\t"]),
        (Backspace, &["\u{7f}"]),
        (Ctrl('h'), &["\u{8}"]),
        (Ctrl('c'), &["\u{3}", "\u{1b}[99;5u"]),
        (Ctrl('z'), &["\u{1a}"]),
        (Ctrl(' '), &["\0"]),
        (Up, &["\u{1b}[A", "\u{1b}OA"]),
        (Down, &["\u{1b}[B"]),
        (Right, &["\u{1b}[C", "\u{1b}[1;5C"]),
        (Left, &["\u{1b}[D"]),
        (Home, &["\u{1b}OH", "\u{1b}[H", "\u{1b}[1~", "\u{1b}[7~"]),
        (End, &["\u{1b}OF", "\u{1b}[F", "\u{1b}[4~", "\u{1b}[8~"]),
        (Delete, &["\u{1b}[3~"]),
        (PageUp, &["\u{1b}[5~", "\u{1b}[5;5~"]),
        (PageDown, &["\u{1b}[6~"]),
        (BackTab, &["\u{1b}[Z", "\u{1b}[9;2u"]),
        (ShiftUp, &["\u{1b}[1;2A", "\u{1b}[a"]),
        (ShiftDown, &["\u{1b}[1;2B"]),
        (ShiftRight, &["\u{1b}[1;2C", "\u{1b}[1;6C", "\u{1b}[1;2:1C"]),
        (ShiftLeft, &["\u{1b}[1;2D"]),
        (Esc, &["\u{1b}[27u"]),
    ];
    for (key, texts) in cases {
        for text in *texts {
            assert_decodes_to(text, &Typed::Key(*key));
        }
    }
}

#[test]
fn ignores_sequences_that_are_no_keys() {
    for text in [
        "\u{1b}[<35;10;20M",
        "\u{1b}[<1;10;20M",
        "\u{1b}[<128;10;20M",
        "\u{1b}[<0;0;20M",
        "\u{1b}[<0;10;0M",
        "\u{1b}[<0;-1;20M",
        "\u{1b}[<0;99999;20M",
        "\u{1b}[<0;10M",
        "\u{1b}[<0;10;20;30M",
        "\u{1b}[<M",
        "\u{1b}[<0;000000000000000000000000010;20M",
        "\u{1b}[M !!",
        "\u{1b}[[A",
        "\u{1b}[I",
        "\u{1b}[O",
        "\u{1b}[24;80R",
        "\u{1b}[?62;4c",
        "\u{1b}[?2026;2$y",
        "\u{1b}[15~",
        "\u{1b}[201~",
        "\u{1b}OP",
        "\u{1b}]10;rgb:0000/0000/0000\u{1b}\\",
        "\u{1b}]11;rgb:00/00\u{7}",
        "\u{1b}]11;rgb:zz/00/00\u{7}",
        "\u{1b}]0;a title\u{7}",
        "\u{1b}P>|a terminal\u{1b}\\",
    ] {
        let with_key = format!("{text}x").into_bytes();
        assert_eq!(typed(&[&with_key]), keys(&[Key::Char('x')]), "{text:?}");
    }
    let no_text: [&[u8]; 4] = [
        b"\xff\x80\xc3x",
        b"\xe9\x80x",
        b"\xf4\x90\x80\x80x",
        b"\xc0x",
    ];
    for bytes in no_text {
        assert_eq!(typed(&[bytes]), keys(&[Key::Char('x')]), "{bytes:?}");
    }
}

#[test]
fn escape_is_a_key_after_a_timeout_or_before_another_key() {
    let (mut decoder, begin) = fed(b"\x1b");
    assert_eq!(decoder.ready(), 0);
    assert_eq!(decoder.deadline(), Some(begin + BYTE_GAP));
    decoder.expire(begin + BYTE_GAP / 2);
    assert_eq!(decoder.ready(), 0);
    decoder.expire(begin + BYTE_GAP);
    assert_eq!(all(&mut decoder), keys(&[Key::Esc]));
    assert_eq!(decoder.deadline(), None);
    // A sequence that arrives too late is read as separate keys.
    decoder.feed(b"\x1b", begin);
    decoder.feed(b"[A", begin + 2 * BYTE_GAP);
    let late = [Key::Esc, Key::Char('['), Key::Char('A')];
    assert_eq!(all(&mut decoder), keys(&late));
    for (text, key) in [
        ("\u{1b}q", Key::Char('q')),
        ("\u{1b}\u{1b}[A", Key::Up),
        ("\u{1b}\u{3}", Key::Ctrl('c')),
        ("\u{1b}ü", Key::Char('ü')),
    ] {
        assert_eq!(
            typed(&[text.as_bytes()]),
            keys(&[Key::Esc, key]),
            "{text:?}"
        );
    }
    decoder.feed(b"\x1bP", begin);
    decoder.expire(begin + BYTE_GAP);
    assert_eq!(all(&mut decoder), keys(&[Key::Esc, Key::Char('P')]));
}

#[test]
fn drops_unfinished_sequences() {
    for begun in [
        "\u{1b}[",
        "\u{1b}[<",
        "\u{1b}[<1;2",
        "\u{1b}]0;a",
        "\u{1b}P",
        "\u{1b}O",
    ] {
        let last = typed(&[begun.as_bytes(), b"\x03"]).pop();
        assert_eq!(last, Some(Typed::Key(Key::Ctrl('c'))), "{begun:?}");
        let (mut decoder, begin) = fed(begun.as_bytes());
        decoder.expire(begin + BYTE_GAP);
        all(&mut decoder);
        decoder.feed(b"x", begin + BYTE_GAP);
        assert_eq!(all(&mut decoder), keys(&[Key::Char('x')]), "{begun:?}");
    }
    // Keys that are held down do not keep it alive for ever either.
    let (mut decoder, begin) = fed(b"\x1b]");
    for number in 1..100 {
        decoder.feed(b"j", begin + BYTE_GAP / 2 * number);
    }
    assert!(decoder.ready() > 70, "{}", decoder.ready());
}

#[test]
fn each_sequence_has_its_own_timeout() {
    // Every piece ends within a sequence, but no sequence waits longer than a moment.
    let (mut decoder, begin) = fed(b"\x1b[");
    for number in 1..=100 {
        decoder.feed(b"A\x1b[", begin + BYTE_GAP / 2 * number);
    }
    assert_eq!(all(&mut decoder), keys(&[Key::Up; 100]));
}

#[test]
fn long_sequences_use_bounded_memory() {
    let (mut decoder, begin) = (Decoder::default(), Instant::now());
    for long in ["\u{1b}[<", "\u{1b}]0;"] {
        decoder.feed(long.as_bytes(), begin);
        decoder.feed(&b"1".repeat(1 << 20), begin);
        assert!(decoder.pending.len() <= LONGEST_SEQUENCE + 2);
        decoder.feed(b"\x1b\\", begin);
        all(&mut decoder);
    }
}

#[test]
fn decodes_a_paste_as_one_input() {
    let paste = |text: &str| Typed::Paste(text.to_owned());
    let text = "\u{1b}[200~a ü\u{1b}[20q\u{1b}\u{1b}[201~";
    assert_decodes_to(text, &paste("a ü\u{1b}[20q\u{1b}"));
    let unfinished = b"\x1b[200~a\x03";
    assert_eq!(typed(&[unfinished]), keys(&[Key::Ctrl('c')]));
    let (mut decoder, begin) = fed(b"\x1b[200~");
    decoder.feed(&b"1".repeat(1 << 20), begin);
    decoder.expire(begin + BYTE_GAP);
    assert_eq!(decoder.ready(), 0);
    decoder.expire(begin + GAP_IN_PASTE);
    assert_eq!(all(&mut decoder), [paste(&"1".repeat(LONGEST_PASTE))]);
}

proptest! {
    #[test]
    fn recovers_from_any_bytes(
        pieces in prop::collection::vec(prop::collection::vec(
            prop_oneof![any::<u8>(), prop::sample::select(b"\x1b[O<MP]~;0123".to_vec())], 0..40), 0..20)
    ) {
        let (mut decoder, mut now) = (Decoder::default(), Instant::now());
        for piece in pieces {
            decoder.feed(&piece, now);
            now += Duration::from_millis(7);
        }
        now += GAP_IN_PASTE;
        decoder.expire(now);
        prop_assert_eq!(decoder.deadline(), None);
        while decoder.take_typed().is_some() {}
        decoder.feed(b"x", now);
        prop_assert_eq!(decoder.take_typed(), Some(Typed::Key(Key::Char('x'))));
    }
}

#[test]
fn decodes_mouse_reports_however_they_are_split() {
    let cases = [
        ("\u{1b}[<0;10;20M", Did::Press, 9, 19),
        ("\u{1b}[<16;1;1M", Did::Press, 0, 0),
        ("\u{1b}[<32;10;20M", Did::Drag, 9, 19),
        ("\u{1b}[<0;10;20m", Did::Release, 9, 19),
        ("\u{1b}[<64;200;50M", Did::WheelUp, 199, 49),
        ("\u{1b}[<65;65535;65535M", Did::WheelDown, 65534, 65534),
    ];
    for (report, did, x, y) in cases {
        assert_decodes_to(report, &Typed::Mouse(Mouse { did, x, y }));
    }
}

#[test]
fn decodes_the_background_color() {
    for (report, background) in [
        (
            "\u{1b}]11;rgb:ffff/ffff/ffff\u{1b}\\",
            Some(Background::Light),
        ),
        ("\u{1b}]11;rgb:1e/1e/2e\u{7}", Some(Background::Dark)),
        ("\u{1b}]11;rgb:fdf6/e3e3/e3\u{7}", Some(Background::Light)),
        ("\u{1b}]11;rgb:zz/00/00\u{7}", None),
        ("\u{1b}]10;rgb:ffff/ffff/ffff\u{7}", None),
    ] {
        let mut decoder = Decoder::default();
        decoder.feed(report.as_bytes(), Instant::now());
        let typed = background.map(Typed::Background);
        assert_eq!(decoder.take_typed(), typed, "{report:?}");
    }
}
