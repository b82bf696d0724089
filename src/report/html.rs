//! Markup: words made safe, tables, and a style that is small, prints, and follows a dark screen. No scripts, no fonts, and
//! nothing from elsewhere.

use super::block::Block;
use super::plot::dark_style;
use super::table::Table;

/// What tells a page of ours from another's.
pub(super) const GENERATOR: &str = "name=\"generator\" content=\"wavelane compare\"";

/// Words with what has a meaning in markup taken out, for text and for attributes in double quotes.
pub(super) fn escaped(words: &str) -> String {
    let mut text = String::with_capacity(words.len());
    for character in words.chars() {
        match character {
            '&' => text += "&amp;",
            '<' => text += "&lt;",
            '>' => text += "&gt;",
            '"' => text += "&quot;",
            '\'' => text += "&#39;",
            // Markup has no way to say control characters; a file name may have them.
            control if control.is_control() => text.push('\u{fffd}'),
            other => text.push(other),
        }
    }
    text
}

pub(super) fn paragraph(words: &str) -> String {
    format!("<p>{}</p>\n", escaped(words))
}

pub(super) fn blocks(blocks: &[Block]) -> String {
    let html = |block: &Block| match block {
        Block::Words(words) => paragraph(words),
        Block::Table(table) => table_of(table),
    };
    blocks.iter().map(html).collect()
}

/// A table whose columns of words head their rows; without `heading`, the first row is one like the others.
fn table_of(table: &Table) -> String {
    let mut html = String::from("<div class=\"wide\"><table>\n");
    for (index, row) in table.rows.iter().enumerate() {
        html += "<tr>";
        for (column, cell) in row.iter().enumerate() {
            let cell = escaped(cell);
            html += &match (index, column < table.words) {
                (0, true) => format!("<th class=\"word\">{cell}</th>"),
                (0, false) => format!("<th>{cell}</th>"),
                (_, true) => format!("<th class=\"word\" scope=\"row\">{cell}</th>"),
                (_, false) => format!("<td>{cell}</td>"),
            };
        }
        html += "</tr>\n";
    }
    html + "</table></div>\n"
}

/// Names and what they are.
pub(super) fn definitions(items: &[(&str, String)]) -> String {
    let row = |(name, value): &(&str, String)| {
        format!(
            "<tr><th class=\"word\" scope=\"row\">{}</th><td class=\"word\">{}</td></tr>\n",
            escaped(name),
            escaped(value)
        )
    };
    format!("<table class=\"facts\">\n{}</table>\n", items.iter().map(row).collect::<String>())
}

/// A plot within the page, where its words can be read and copied and its colours follow the page's.
pub(super) fn plot(svg: &str, file: &str, caption: &str) -> String {
    let name = escaped(caption);
    // Within a page the namespace goes without saying.
    let svg = svg.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    let svg = svg.replacen("<svg ", &format!("<svg role=\"img\" aria-label=\"{name}\" "), 1);
    format!("<figure>\n{svg}<figcaption>{name} <a href=\"{file}\">SVG</a></figcaption>\n</figure>\n")
}

/// A picture file of a size in pixels, which may be enlarged.
pub(super) fn picture(file: &str, size: [u32; 2], caption: &str) -> String {
    let [width, height] = size;
    let caption = escaped(caption);
    // A picture that is shown smaller than it is looks wrong without smoothing, and one that is enlarged with it.
    const SHOWN: u32 = 440;
    let class = if width < SHOWN { " class=\"small\"" } else { "" };
    format!(
        "<figure>\n<a href=\"{file}\"><img{class} src=\"{file}\" width=\"{width}\" height=\"{height}\" alt=\"{caption}\" /></a>\n\
         <figcaption>{caption}</figcaption>\n</figure>\n"
    )
}

pub(super) fn section(heading: &str, content: &str) -> String {
    format!("<section>\n<h2>{}</h2>\n{content}</section>\n", escaped(heading))
}

/// A whole page.
pub(super) fn document(title: &str, content: &str) -> String {
    let (title, dark) = (escaped(title), dark_style());
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\" />\n<meta {GENERATOR} />\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\" />\n\
         <title>{title}</title>\n<style>\n{STYLE}@media screen and (prefers-color-scheme: dark) {{\n{DARK}{dark}}}\n</style>\n\
         </head>\n<body>\n<h1>{title}</h1>\n{content}</body>\n</html>\n"
    )
}

const STYLE: &str = "\
:root { color-scheme: light dark; --ink: #22262a; --muted: #6a7076; --line: #e2e5e8; --paper: #ffffff; --link: #276cad }
body { margin: 2rem auto; padding: 0 1rem; max-width: 66rem; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, sans-serif }
h1 { font-size: 1.6rem; margin: 0 0 .25rem; overflow-wrap: anywhere }
h2 { font-size: 1.15rem; margin: 2.5rem 0 .5rem }
p { max-width: 44rem }
a { color: var(--link) }
figure { margin: 1rem 0 }
figcaption { font-size: .85rem; color: var(--muted); max-width: 44rem }
svg { display: block; max-width: 100%; height: auto }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(22rem, 100%), 1fr)); gap: 0 1.5rem }
img { display: block; width: 100%; height: auto; background: #000000 }
img.small { image-rendering: pixelated }
.wide { overflow-x: auto; margin: .5rem 0 1.5rem }
table { border-collapse: collapse; font-size: .78rem; font-variant-numeric: tabular-nums }
th, td { padding: .2rem .4rem; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--line) }
th { font-weight: 600 }
th.word, td.word { text-align: left }
.facts td { white-space: normal; overflow-wrap: anywhere }
pre { font-size: .8rem; white-space: pre-wrap; overflow-wrap: anywhere; border-left: 3px solid var(--line); padding-left: .75rem }
@media print { html, body { font-size: 11px } body { margin: 0; max-width: none } svg { max-width: 15cm }
  .pictures { grid-template-columns: 1fr 1fr } .wide table { font-size: 7.5px } th, td { padding: .1rem .25rem }
  p, pre, figcaption { max-width: 15cm } figure, tr { break-inside: avoid } h2 { break-after: avoid }
  a { color: inherit; text-decoration: none } }
";

const DARK: &str =
    ":root { --ink: #e4e6e8; --muted: #9ca2a8; --line: #34383c; --paper: #181a1c; --link: #7db2e6 }\n";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_cannot_become_markup() {
        assert_eq!(escaped("a<b&\"c'>\n"), "a&lt;b&amp;&quot;c&#39;&gt;\u{fffd}");
    }

    #[test]
    fn columns_of_words_head_their_rows() {
        let mut table = Table::new(1, ["a", "b"]);
        table.push(vec!["<".into(), "1".into()]);
        let html = blocks(&[Block::Table(table)]);
        assert!(html.contains("<tr><th class=\"word\">a</th><th>b</th></tr>"), "{html}");
        assert!(html.contains("<th class=\"word\" scope=\"row\">&lt;</th><td>1</td>"), "{html}");
    }
}
