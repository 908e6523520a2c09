/// Checks that a text is one well-formed element: tags balance, text and attributes are escaped.
pub(crate) fn check(text: &str) -> Result<(), String> {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = text.trim();
    let mut roots = 0;
    while !rest.is_empty() {
        let (content, tag_on) = rest.split_once('<').unwrap_or((rest, ""));
        check_text(content)?;
        if open.is_empty() && !content.trim().is_empty() {
            return Err(format!("text outside of the root: {content}"));
        }
        if tag_on.is_empty() {
            break;
        }
        let (tag, after) = tag_on.split_once('>').ok_or("a tag does not end")?;
        if tag.contains('<') {
            return Err(format!("`<` inside of tag {tag}"));
        }
        if let Some(name) = tag.strip_prefix('/') {
            let opened = open.pop();
            if opened != Some(name.trim()) {
                return Err(format!("</{name}> closes {opened:?}"));
            }
        } else {
            let name = tag.split([' ', '/']).next().unwrap_or_default();
            check_attributes(tag)?;
            roots += usize::from(open.is_empty());
            if !tag.ends_with('/') {
                open.push(name);
            }
        }
        rest = after;
    }
    if open.is_empty() && roots == 1 { Ok(()) } else { Err(format!("{open:?}, {roots} roots")) }
}

fn check_attributes(tag: &str) -> Result<(), String> {
    let quotes = tag.matches('"').count();
    if !quotes.is_multiple_of(2) {
        return Err(format!("odd quotes in <{tag}>"));
    }
    tag.split('"').skip(1).step_by(2).try_for_each(check_text)
}

fn check_text(text: &str) -> Result<(), String> {
    let forbidden = |c: char| c < ' ' && !matches!(c, '\t' | '\n' | '\r');
    if text.contains(forbidden) {
        return Err(format!("a control character in {text:?}"));
    }
    let known = ["amp;", "lt;", "gt;", "quot;", "apos;", "#39;"];
    match text.split('&').skip(1).find(|after| !known.iter().any(|k| after.starts_with(k))) {
        Some(after) => Err(format!("a bare `&` before {after:?}")),
        None => Ok(()),
    }
}

#[test]
fn the_check_itself_refuses_what_is_broken() {
    assert_eq!(check("<a><b x=\"1\"/>t &amp; u</a>"), Ok(()));
    for broken in ["<a><b></a>", "<a>x & y</a>", "<a/><b/>", "<a x=\"1>", "<a>\u{7}</a>", "t", ""] {
        assert!(check(broken).is_err(), "{broken}");
    }
}
