//! Provenance of a figure: the runs or the table that it shows, and the request that it answers, embedded in the file
//! of the figure.
//!
//! They form one text: a line with the SHA-256 of the rest, a head in TOML, and then the unchanged files that the head
//! lists. `svg`, `pdf` and `png` embed this text in the file of a picture and extract it. Extraction restores the
//! original picture.

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

/// Maximum size of a figure's file, bytes.
const LONGEST_FIGURE: u64 = 128 << 20;
/// Maximum size of the head, bytes: enough for the names of some thousand runs.
const LONGEST_HEAD: usize = 256 << 10;
/// Maximum compressed size of embedded data and tables, bytes. Larger ones are not embedded.
const MOST_DATA: usize = 1 << 20;

const FIGURE_MARK: &str = "# gyrolab figure, sha256 ";
/// Key in the request for a picture of the lab's screen, which is not a figure.
pub const SCREEN: &str = "screen";

/// Sources of a figure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// Version of the program that drew it.
    pub gyrolab: String,
    /// SHA-256 of the picture without this text.
    picture_sha256: String,
    /// What its readers must know of its runs, such as that one is not reliable.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub caveats: Vec<String>,
    /// Request for the figure, with keys and values of the module that draws it.
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
    /// SHA-256 of a file that is too large to be embedded.
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
            caveats: Vec::new(),
            figure: toml::Table::try_from(asked).unwrap_or_default(), // a struct that can be parsed again
            files,
        }
    }

    /// Returns the files with this kind of payload.
    pub fn all(&self, holds: Payload) -> impl Iterator<Item = &File> {
        self.files.iter().filter(move |file| file.holds == holds)
    }

    /// Returns the text to embed in `picture`, the bytes of its file without it.
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

    /// Parses the embedded `text`.
    fn read(text: &str) -> Result<Self, String> {
        let rest = text.strip_prefix(FIGURE_MARK).ok_or(BROKEN)?;
        let (sum, rest) = rest.split_at_checked(64).ok_or(BROKEN)?;
        if sum != sha256(rest.as_bytes()) {
            return Err("its run was changed after it was drawn: the SHA-256 differs".to_owned());
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

/// File formats in which a text can be embedded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileFormat {
    Svg,
    Pdf,
    Png,
}

impl FileFormat {
    /// Returns the format of a file by its first bytes. `None` if it is not a figure.
    pub fn detect(bytes: &[u8]) -> Option<Self> {
        let text = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
        match text.trim_ascii_start() {
            _ if bytes.starts_with(b"%PDF-") => Some(Self::Pdf),
            _ if bytes.starts_with(png::SIGNATURE) => Some(Self::Png),
            [b'<', ..] => Some(Self::Svg),
            _ => None,
        }
    }

    /// Returns the bytes that follow the embedded text.
    fn end(self) -> &'static [u8] {
        match self {
            Self::Svg => svg::END_OF_FILE,
            Self::Pdf => b"",
            Self::Png => png::IEND_CHUNK,
        }
    }

    /// Returns the bytes in which `text` is embedded after `before`.
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

/// Embeds the origin in `picture`, a file that this program wrote. `None` if it is too long.
pub fn embed(picture: &[u8], origin: &Origin) -> Option<Vec<u8>> {
    FileFormat::detect(picture)?.embed(picture, &origin.text(picture)?)
}

/// A figure read from a file.
#[derive(Clone, Debug)]
pub struct FigureFile {
    pub form: FileFormat,
    pub origin: Origin,
    /// The file without the embedded text.
    pub picture: Vec<u8>,
    /// Describes a change of the file after it was drawn, if there is one.
    pub changed: Option<&'static str>,
}

impl FigureFile {
    /// Parses the bytes of a figure's file.
    ///
    /// A file may be large. It is not copied, and two copies of its text exist only as long as needed.
    ///
    /// # Errors
    /// Returns why no run can be extracted from it.
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
        // Another version may have compressed the text differently.
        let is_own = origin.gyrolab == env!("CARGO_PKG_VERSION");
        let changed = if origin.picture_sha256 != sha256(&file) {
            Some("its picture was changed after it was drawn: the SHA-256 differs")
        } else if is_own && !is_as_written {
            Some("its file was changed after it was drawn, but not its picture or its run")
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

    /// Reads the figure in the file `path`. `None` if it is not a figure, or does not exist.
    pub fn open(path: &Path) -> Result<Option<Self>, String> {
        if !path.is_file() {
            return Ok(None);
        }
        let file = Opened::open(path).map_err(|error| unread(&error))?;
        Self::read(&mut BufReader::new(file))
    }

    /// Reads a figure from `reader`. If it is not a figure, only its first bytes are read.
    pub fn read(reader: &mut impl BufRead) -> Result<Option<Self>, String> {
        let first = reader.fill_buf().map_err(|error| unread(&error))?;
        if FileFormat::detect(first).is_none() {
            return Ok(None);
        }
        let mut file = Vec::new();
        let read = reader.take(LONGEST_FIGURE + 1).read_to_end(&mut file);
        read.map_err(|error| unread(&error))?;
        if file.len() as u64 > LONGEST_FIGURE {
            return Err("is larger than 128 MiB, the limit for a figure".to_owned());
        }
        Self::parse(file).map(Some)
    }
}

/// Returns the name of an embedded file, without any folder of this machine.
pub fn name_of(name: &str) -> String {
    let path = Path::new(name);
    let file = path.file_name().filter(|_| path.is_absolute());
    file.map_or(name.into(), |file| file.to_string_lossy())
        .into_owned()
}

/// Returns the SHA-256 of `bytes` in hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    let sum = Sha256::digest(bytes);
    sum.iter().map(|byte| format!("{byte:02x}")).collect()
}
