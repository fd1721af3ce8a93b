//! Names of rows in the words of the case file, where they are made of the text that a value has for programmers.

/// `NonsmoothAlpha(NonsmoothAlpha { rho_inf: 1.0 }), Half` becomes `nonsmooth-alpha, rho_inf = 1.0, Half`: names of several words as in
/// the case file, parameters behind commas.
pub fn words(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(begin) = rest.find(|c: char| c.is_ascii_uppercase()) {
        let (before, from) = rest.split_at(begin);
        out.push_str(before);
        let end = from.find(|c: char| !c.is_ascii_alphanumeric());
        let (name, after) = from.split_at(end.unwrap_or(from.len()));
        let begins = !out.ends_with(|c: char| c.is_alphanumeric());
        let wrapped = after.strip_prefix('(').and_then(|a| a.strip_prefix(name));
        rest = match wrapped.and_then(parameters).filter(|_| begins) {
            Some((parameters, after)) => {
                out.push_str(&hyphened(name));
                out.push_str(&parameters);
                after
            }
            None => {
                out.push_str(&match begins && has_words(name) {
                    true => hyphened(name),
                    false => name.to_owned(),
                });
                after
            }
        };
    }
    out + rest
}

/// What stands within ` { a: 1 })` as `, a = 1`, or nothing within `)`; and what follows.
fn parameters(text: &str) -> Option<(String, &str)> {
    if let Some(after) = text.strip_prefix(')') {
        return Some((String::new(), after));
    }
    let (inner, after) = text.strip_prefix(" { ")?.split_once(" })")?;
    Some((format!(", {}", inner.replace(": ", " = ")), after))
}

/// Whether a name is made of several words of three letters or more.
fn has_words(name: &str) -> bool {
    let hyphened = hyphened(name);
    hyphened.contains('-') && hyphened.split('-').all(|word| word.len() > 2)
}

/// `NonsmoothAlpha` as `nonsmooth-alpha`.
fn hyphened(name: &str) -> String {
    let mut out = String::new();
    for letter in name.chars() {
        if letter.is_ascii_uppercase() && out.ends_with(|c: char| c.is_ascii_lowercase()) {
            out.push('-');
        }
        out.push(letter.to_ascii_lowercase());
    }
    out
}
