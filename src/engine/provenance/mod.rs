//! Where a figure comes from: the runs or the table that it shows and what it was asked to show of them, carried by the file
//! of the figure itself.
//!
//! They are one text: a line with the SHA-256 of the rest, a head in TOML, then the files that the head lists, as they are.
//! `svg`, `pdf` and `png` put this text into the file of a picture and find it there; taken out, it leaves that file
//! as it was.

mod extracted;
mod pdf;
mod png;
mod svg;

use crate::text::io_errors::unread;
use crate::text::printable::brief;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fs::File as Opened;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use extracted::{BROKEN, Extracted, LONGEST_TEXT, NO_RUN_TEXT, packed};

/// The longest file of a figure that is read, bytes.
const LONGEST_FIGURE: u64 = 128 << 20;
/// The longest head of it, bytes: the names of some thousand runs.
const LONGEST_HEAD: usize = 256 << 10;
/// Data and tables that are longer when compressed do not travel, bytes.
const MOST_DATA: usize = 1 << 20;

const FIGURE_MARK: &str = "# gyrolab figure, sha256 ";
/// The key of what was asked of a picture that is the lab's screen, and no figure.
pub const SCREEN: &str = "screen";

/// What a figure was drawn from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// The version that drew it.
    pub gyrolab: String,
    /// Of the picture that carries this, without it.
    picture_sha256: String,
    /// What it was asked to show: keys and values of the room that draws.
    pub figure: toml::Table,
    #[serde(rename = "file")]
    pub files: Vec<File>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Payload {
    Run,
    Data,
    Table,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct File {
    pub holds: Payload,
    pub name: String,
    bytes: usize,
    /// Of a file that is too large to travel.
    pub sha256: Option<String>,
    #[serde(skip)]
    pub text: String,
}

impl File {
    pub fn new(holds: Payload, name: &str, text: &str) -> Self {
        let travels = holds == Payload::Run
            || text.len() <= MOST_DATA
            || packed(text.as_bytes()).len() <= MOST_DATA;
        let carried = if travels { text } else { "" };
        Self {
            holds,
            name: name_of(name),
            bytes: carried.len(),
            sha256: (!travels).then(|| sha256(text.as_bytes())),
            text: carried.to_owned(),
        }
    }
}

impl Origin {
    pub fn new(asked: &impl Serialize, files: Vec<File>) -> Self {
        Self {
            gyrolab: env!("CARGO_PKG_VERSION").to_owned(),
            picture_sha256: String::new(),
            figure: toml::Table::try_from(asked).unwrap_or_default(), // a struct that is read back
            files,
        }
    }

    /// The files that hold this.
    pub fn all(&self, holds: Payload) -> impl Iterator<Item = &File> {
        self.files.iter().filter(move |file| file.holds == holds)
    }

    /// The text that is carried by the `picture`, a file without it.
    fn text(&self, picture: &[u8]) -> Option<String> {
        let head = toml::to_string(&Self {
            picture_sha256: sha256(picture),
            ..self.clone()
        });
        let head = head.ok().filter(|head| head.len() <= LONGEST_HEAD)?;
        let contents: String = self.files.iter().map(|file| file.text.as_str()).collect();
        let rest = format!(", head {}\n{head}{contents}", head.len());
        let text = format!("{FIGURE_MARK}{}{rest}", sha256(rest.as_bytes()));
        (text.len() <= LONGEST_TEXT).then_some(text)
    }

    /// What the carried `text` holds.
    fn read(text: &str) -> Result<Self, String> {
        let rest = text.strip_prefix(FIGURE_MARK).ok_or(BROKEN)?;
        let (sum, rest) = rest.split_at_checked(64).ok_or(BROKEN)?;
        if sum != sha256(rest.as_bytes()) {
            return Err(
                "its run was changed after it was drawn: the SHA-256 is another".to_owned(),
            );
        }
        let (first_line, head_and_files) = rest.split_once('\n').ok_or(BROKEN)?;
        let (head, mut files) = first_line
            .strip_prefix(", head ")
            .and_then(|length| length.parse().ok())
            .filter(|length| *length <= LONGEST_HEAD)
            .and_then(|length| head_and_files.split_at_checked(length))
            .ok_or(BROKEN)?;
        let mut origin: Self = toml::from_str(head).map_err(|error| {
            let [version, why] =
                [head.lines().next().unwrap_or_default(), error.message()].map(|it| brief(it, 120));
            let own = env!("CARGO_PKG_VERSION");
            format!("its metadata ({version}) is not understood by gyrolab {own}: {why}")
        })?;
        for file in &mut origin.files {
            let (own, after) = files.split_at_checked(file.bytes).ok_or(BROKEN)?;
            (file.text, files) = (own.to_owned(), after);
        }
        let is_whole = files.is_empty() && !origin.files.is_empty();
        is_whole.then_some(origin).ok_or(BROKEN.to_owned())
    }
}

/// The forms of file that carry a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileFormat {
    Svg,
    Pdf,
    Png,
}

impl FileFormat {
    /// Returns the format of a file by its first bytes, or `None` if it is no figure.
    pub fn detect(bytes: &[u8]) -> Option<Self> {
        let text = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
        match text.trim_ascii_start() {
            _ if bytes.starts_with(b"%PDF-") => Some(Self::Pdf),
            _ if bytes.starts_with(png::SIGNATURE) => Some(Self::Png),
            [b'<', ..] => Some(Self::Svg),
            _ => None,
        }
    }

    /// Returns what stands behind the bytes that carry a text.
    fn end(self) -> &'static [u8] {
        match self {
            Self::Svg => svg::END_OF_FILE,
            Self::Pdf => b"",
            Self::Png => png::IEND_CHUNK,
        }
    }

    /// Returns the bytes that carry `text` behind `before`.
    fn carrier(self, before: &[u8], text: &str) -> Option<Vec<u8>> {
        match self {
            Self::Svg => Some(svg::carrier(text)),
            Self::Pdf => pdf::carrier(before, text),
            Self::Png => png::carrier(text),
        }
    }

    fn embed(self, picture: &[u8], text: &str) -> Option<Vec<u8>> {
        let before = picture.strip_suffix(self.end())?;
        Some([before, &self.carrier(before, text)?, self.end()].concat())
    }

    fn extract(self, file: &[u8]) -> Result<Extracted, &'static str> {
        match self {
            Self::Svg => svg::extract(file),
            Self::Pdf => pdf::extract(file),
            Self::Png => png::extract(file),
        }
    }
}

/// The `picture`, a file that this program wrote, with its origin in it; `None` where that is too long.
pub fn embed(picture: &[u8], origin: &Origin) -> Option<Vec<u8>> {
    FileFormat::detect(picture)?.embed(picture, &origin.text(picture)?)
}

/// A figure that was read.
#[derive(Clone, Debug)]
pub struct FigureFile {
    pub form: FileFormat,
    pub origin: Origin,
    /// Its file without what it carries.
    pub picture: Vec<u8>,
    /// What was changed in the file after it was drawn, where something was.
    pub changed: Option<&'static str>,
}

impl FigureFile {
    /// Parses the bytes of a figure's file. The error says why no run can be extracted from it.
    ///
    /// A file may be large: it is not copied, and two copies of its text exist only as long as needed.
    pub fn parse(mut file: Vec<u8>) -> Result<Self, String> {
        let form = FileFormat::detect(&file).ok_or(NO_RUN_TEXT)?;
        let Extracted { carrier, text } = form.extract(&file)?;
        let text = String::from_utf8(text).map_err(|_| BROKEN)?;
        let (before, rest) = file.split_at(carrier.start);
        let is_as_written = rest[carrier.len()..] == *form.end()
            && form.carrier(before, &text).as_deref() == Some(&rest[..carrier.len()]);
        let origin = Origin::read(&text)?;
        drop(text);
        file.drain(carrier);
        // Another version may have compressed the text otherwise.
        let is_own = origin.gyrolab == env!("CARGO_PKG_VERSION");
        let changed = if origin.picture_sha256 != sha256(&file) {
            Some("its picture was changed after it was drawn: the SHA-256 is another")
        } else if is_own && !is_as_written {
            Some("its file was changed after it was drawn, though not its picture and not its run")
        } else {
            None
        };
        Ok(Self {
            form,
            origin,
            picture: file,
            changed,
        })
    }

    /// Reads the figure in the file `path`; `None` where that is no figure, or not there.
    pub fn open(path: &Path) -> Result<Option<Self>, String> {
        if !path.is_file() {
            return Ok(None);
        }
        let file = Opened::open(path).map_err(|error| unread(&error))?;
        Self::read(&mut BufReader::new(file))
    }

    /// The same for what `reader` gives, of which only the first bytes are looked at where it is no figure.
    pub fn read(reader: &mut impl BufRead) -> Result<Option<Self>, String> {
        let first = reader.fill_buf().map_err(|error| unread(&error))?;
        if FileFormat::detect(first).is_none() {
            return Ok(None);
        }
        let mut file = Vec::new();
        let read = reader.take(LONGEST_FIGURE + 1).read_to_end(&mut file);
        read.map_err(|error| unread(&error))?;
        if file.len() as u64 > LONGEST_FIGURE {
            return Err("is longer than 128 MiB, the most that is read of a figure".to_owned());
        }
        Self::parse(file).map(Some)
    }
}

/// What a file is called where it travels: no folder of this machine is told.
pub fn name_of(name: &str) -> String {
    let path = Path::new(name);
    let file = path.file_name().filter(|_| path.is_absolute());
    file.map_or(name.into(), |file| file.to_string_lossy())
        .into_owned()
}

/// The SHA-256 of `bytes` in hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    let sum = Sha256::digest(bytes);
    sum.iter().map(|byte| format!("{byte:02x}")).collect()
}
