//! The `scp` command that fetches a file from this machine.

use crate::text::printable::printable;
use std::ffi::OsStr;
use std::path::Path;

/// The `scp` command that the user types on their own machine to fetch the file `path` from this one; `None` where the
/// lab does not run over SSH. Where the name of the file, the user or the machine cannot be typed in a shell, a message
/// that says so.
pub fn scp_line(path: &Path) -> Option<String> {
    // ssh sets it to "CLIENT CLIENT_PORT SERVER SERVER_PORT".
    let connection = std::env::var("SSH_CONNECTION").ok()?;
    let user = ["USER", "LOGNAME"]
        .into_iter()
        .find_map(std::env::var_os)
        .unwrap_or_default();
    let port = connection.split(' ').nth(3).unwrap_or_default();
    let made = scp_line_from(port, &user, &gethostname::gethostname(), path.as_os_str());
    Some(made.unwrap_or_else(|what| {
        format!("no scp line: {what} holds characters that cannot be typed in a shell")
    }))
}

/// The command, or which part of it cannot be typed. An empty `user` is left out.
fn scp_line_from(
    port: &str,
    user: &OsStr,
    host: &OsStr,
    path: &OsStr,
) -> Result<String, &'static str> {
    let port = match port.parse::<u16>() {
        Ok(22) | Err(_) => String::new(),
        Ok(port) => format!("-P {port} "),
    };
    let user = if user.is_empty() {
        String::new()
    } else {
        format!("{}@", name(user).ok_or("the user's name")?)
    };
    let host = name(host).ok_or("this machine's name")?;
    let path = path.to_str().filter(|path| printable(path) == *path);
    let place = format!("{user}{host}:{}", path.ok_or("its name")?);
    let quoted = shlex::try_quote(&place).map_err(|_| "its name")?;
    Ok(format!("scp {port}{quoted} ."))
}

/// `text` if it is a name of a user or a machine that scp does not mistake for an option or a path.
fn name(text: &OsStr) -> Option<&str> {
    let is_plain = |c: char| c.is_alphanumeric() || "._-@+%\\$".contains(c);
    text.to_str()
        .filter(|name| !name.is_empty() && !name.starts_with('-') && name.chars().all(is_plain))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(port: &str, user: &str, host: &str, path: &str) -> Result<String, &'static str> {
        let [user, host, path] = [user, host, path].map(OsStr::new);
        scp_line_from(port, user, host, path)
    }

    #[test]
    fn an_scp_line_can_be_pasted() {
        assert_eq!(
            line("22", "ada", "lab.example.org", "/home/ada/run-1.csv").unwrap(),
            "scp ada@lab.example.org:/home/ada/run-1.csv ."
        );
        for path in [
            "/tmp/Ada's run $1.csv",
            "/tmp/a\"b`c!d\\e;f&g|h<i>j(k)l*m?n[o]p{q}r~s#t.csv",
            "/tmp/速い.csv",
        ] {
            let line = line("2222", "", "lab", path).unwrap();
            let words = ["scp", "-P", "2222", &format!("lab:{path}"), "."];
            assert_eq!(shlex::split(&line).unwrap(), words, "{line}");
        }
    }

    #[test]
    fn names_that_cannot_be_typed_give_no_scp_line() {
        for (user, host, path) in [
            ("ada", "lab", "/tmp/a\u{1b}]0;x\u{7}.csv"),
            ("ada", "lab", "/tmp/a\nb.csv"),
            ("ada", "lab", "/tmp/a\u{200b}.csv"),
            ("a\u{1b}[2Jda", "lab", "/tmp/a.csv"),
            ("-oProxyCommand=sh", "lab", "/tmp/a.csv"),
            ("ada", "la\u{202e}b", "/tmp/a.csv"),
            ("ada", "", "/tmp/a.csv"),
        ] {
            line("22", user, host, path).unwrap_err();
        }
    }
}
