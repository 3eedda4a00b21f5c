//! Properties of XMP (ISO 16684-1:2019): read from a packet or a sidecar, and written as one.

use std::collections::BTreeMap;
use std::fmt::Write;

use roxmltree::{Document, Node, ParsingOptions};

use super::spaces::{RDF, XML, prefix_of};

/// No packet has more elements.
const MOST_NODES: u32 = 200_000;
/// Values in values that are looked at; real ones have four.
const DEEPEST: usize = 12;

/// Name of a property: its name space and its name in there.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Name {
    pub(crate) space: String,
    pub(crate) local: String,
}

impl Name {
    pub(crate) fn new(space: &str, local: &str) -> Self {
        Self { space: space.to_owned(), local: local.to_owned() }
    }
}

/// How the values of a list belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum List {
    /// In any order.
    Bag,
    /// In this order.
    Seq,
    /// One of them holds, the first one by default.
    Alt,
}

impl List {
    const ALL: [(Self, &'static str); 3] = [(Self::Bag, "Bag"), (Self::Seq, "Seq"), (Self::Alt, "Alt")];

    fn name(self) -> &'static str {
        Self::ALL.iter().find(|(list, _)| *list == self).map_or("Bag", |(_, name)| name)
    }
}

/// What a property says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Said {
    /// A text, and the language that it is in, where that is stated.
    Text(String, Option<String>),
    /// Several.
    Many(List, Vec<Self>),
    /// Properties of its own.
    Parts(Vec<(Name, Self)>),
}

impl Said {
    pub(crate) fn text(text: &str) -> Self {
        Self::Text(text.to_owned(), None)
    }

    /// A text in whatever language, as titles, descriptions and rights are.
    pub(crate) fn in_any_language(text: &str) -> Self {
        Self::Many(List::Alt, vec![Self::Text(text.to_owned(), Some("x-default".to_owned()))])
    }

    /// The texts of it, without those of its parts.
    pub(crate) fn texts(&self) -> Vec<&str> {
        match self {
            Self::Text(text, _) => vec![text],
            Self::Many(_, values) => values.iter().flat_map(Self::texts).collect(),
            Self::Parts(_) => Vec::new(),
        }
    }
}

/// What is said of a photograph.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Xmp {
    pub(crate) said: BTreeMap<Name, Said>,
}

impl Xmp {
    /// From a packet or the text of a sidecar.
    ///
    /// # Errors
    /// It is not XML, or there is no RDF in it: what is wrong, in words.
    pub fn parse(text: &str) -> Result<Self, String> {
        let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
        let text = text.trim_start_matches('\u{feff}').trim_end_matches(['\0', ' ', '\n', '\r', '\t']);
        let document = Document::parse_with_options(text, options).map_err(|e| e.to_string())?;
        let mut rdf = document.descendants().filter(|node| node.has_tag_name((RDF, "RDF"))).peekable();
        if rdf.peek().is_none() {
            return Err("there is no rdf:RDF in it".to_owned());
        }
        let mut said = BTreeMap::new();
        for about in rdf.flat_map(|rdf| rdf.children()).filter(|node| node.has_tag_name((RDF, "Description")))
        {
            said.extend(parts(about, 0));
        }
        Ok(Self { said })
    }

    /// What a property says.
    pub(crate) fn get(&self, space: &str, local: &str) -> Option<&Said> {
        self.said.get(&Name::new(space, local))
    }

    /// The texts that a property says, joined.
    pub(crate) fn text(&self, space: &str, local: &str) -> Option<String> {
        let said = self.get(space, local)?;
        let texts = match said {
            // The first is the default.
            Said::Many(List::Alt, values) => values.first().map(Said::texts).unwrap_or_default(),
            said => said.texts(),
        };
        let text = texts.join("; ");
        let text = text.trim();
        (!text.is_empty()).then(|| text.to_owned())
    }

    pub(crate) fn set(&mut self, space: &str, local: &str, said: Said) {
        self.said.insert(Name::new(space, local), said);
    }

    /// What `other` says counts more.
    pub(crate) fn lay(&mut self, other: &Self) {
        self.said.extend(other.said.iter().map(|(name, said)| (name.clone(), said.clone())));
    }

    /// As a packet (ISO 16684-1, 7.3); nothing where nothing is said.
    pub fn packet(&self) -> String {
        if self.said.is_empty() {
            return String::new();
        }
        let mut spaces = Vec::new();
        let mut body = String::new();
        for (name, said) in &self.said {
            element(&mut body, name, said, &mut spaces);
        }
        let mut names = String::new();
        for (i, space) in spaces.iter().enumerate() {
            let _ = write!(names, " xmlns:{}=\"{}\"", prefix(space, i), escaped(space));
        }
        format!(
            "<?xpacket begin=\"\u{feff}\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n\
             <rdf:RDF xmlns:rdf=\"{RDF}\">\n<rdf:Description rdf:about=\"\"{names}>\n{body}</rdf:Description>\n</rdf:RDF>\n\
             </x:xmpmeta>\n<?xpacket end=\"w\"?>"
        )
    }
}

/// The properties of an element: its attributes and its children.
fn parts(node: Node<'_, '_>, depth: usize) -> Vec<(Name, Said)> {
    let attributes = node.attributes().filter_map(|attribute| {
        let space = attribute.namespace().filter(|space| ![RDF, XML].contains(space))?;
        Some((Name::new(space, attribute.name()), Said::text(attribute.value())))
    });
    let children = node.children().filter_map(|child| {
        let space = child.tag_name().namespace().filter(|space| child.is_element() && *space != RDF)?;
        Some((Name::new(space, child.tag_name().name()), said(child, depth + 1)?))
    });
    attributes.chain(children).collect()
}

/// What the element of a property, or of one value of a list, says; `None` where it says nothing that can be kept.
fn said(node: Node<'_, '_>, depth: usize) -> Option<Said> {
    if depth > DEEPEST {
        return None;
    }
    let language = node.attribute((XML, "lang")).map(str::to_owned);
    if let Some(address) = node.attribute((RDF, "resource")) {
        return Some(Said::Text(address.to_owned(), language));
    }
    let inner = node.children().find(|child| child.is_element() && child.tag_name().namespace() == Some(RDF));
    if let Some(inner) = inner {
        let list = List::ALL.iter().find(|(_, name)| *name == inner.tag_name().name());
        if let Some((list, _)) = list {
            let values = inner.children().filter(|child| child.has_tag_name((RDF, "li")));
            return Some(Said::Many(*list, values.filter_map(|value| said(value, depth + 1)).collect()));
        }
        return Some(Said::Parts(parts(inner, depth)));
    }
    let own = parts(node, depth);
    if !own.is_empty() {
        return Some(Said::Parts(own));
    }
    let text: String = node.children().filter_map(|child| child.text().filter(|_| child.is_text())).collect();
    Some(Said::Text(text, language))
}

fn prefix(space: &str, i: usize) -> String {
    prefix_of(space).map_or_else(|| format!("ns{i}"), str::to_owned)
}

fn tag(name: &Name, spaces: &mut Vec<String>) -> String {
    let i = spaces.iter().position(|space| *space == name.space).unwrap_or_else(|| {
        spaces.push(name.space.clone());
        spaces.len() - 1
    });
    format!("{}:{}", prefix(&name.space, i), name.local)
}

fn element(out: &mut String, name: &Name, said: &Said, spaces: &mut Vec<String>) {
    let tag = tag(name, spaces);
    value(out, &tag, said, spaces);
}

fn value(out: &mut String, tag: &str, said: &Said, spaces: &mut Vec<String>) {
    match said {
        Said::Text(text, language) => {
            let language = language.as_deref().map(|l| format!(" xml:lang=\"{}\"", escaped(l)));
            let _ = writeln!(out, "<{tag}{}>{}</{tag}>", language.unwrap_or_default(), escaped(text));
        }
        Said::Many(list, values) => {
            let list = list.name();
            let _ = writeln!(out, "<{tag}><rdf:{list}>");
            values.iter().for_each(|one| value(out, "rdf:li", one, spaces));
            let _ = writeln!(out, "</rdf:{list}></{tag}>");
        }
        Said::Parts(parts) => {
            let _ = writeln!(out, "<{tag} rdf:parseType=\"Resource\">");
            parts.iter().for_each(|(name, said)| element(out, name, said, spaces));
            let _ = writeln!(out, "</{tag}>");
        }
    }
}

/// A text in XML 1.0; characters that XML has no place for become spaces.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\t' => out.push(c),
            '\u{fffe}' | '\u{ffff}' => out.push(' '),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::spaces::{DC, LR, PHOTOSHOP, XMP};
    use super::*;

    /// As Lightroom, darktable and digiKam write them: attributes, elements, lists, languages, structures.
    const SIDECAR: &str = r#"<?xpacket begin="" id="W5M0MpCehiHzreSzNTczkc9d"?>
<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">
 <rdf:Description rdf:about="" xmlns:xmp="http://ns.adobe.com/xap/1.0/" xmlns:dc="http://purl.org/dc/elements/1.1/"
   xmlns:lr="http://ns.adobe.com/lightroom/1.0/" xmlns:photoshop="http://ns.adobe.com/photoshop/1.0/"
   xmlns:own="http://example.com/own/" xmp:Rating="4" photoshop:City="Zürich &amp; Umgebung">
  <dc:title><rdf:Alt><rdf:li xml:lang="x-default">Morning</rdf:li><rdf:li xml:lang="de">Morgen</rdf:li></rdf:Alt></dc:title>
  <dc:subject><rdf:Bag><rdf:li>fog</rdf:li><rdf:li>lake</rdf:li></rdf:Bag></dc:subject>
  <lr:hierarchicalSubject><rdf:Bag><rdf:li>weather|fog</rdf:li></rdf:Bag></lr:hierarchicalSubject>
  <own:place rdf:parseType="Resource"><own:row>3</own:row><own:of rdf:resource="http://example.com/x"/></own:place>
  <own:kept><rdf:Description own:a="1"><own:b>2</own:b></rdf:Description></own:kept>
 </rdf:Description></rdf:RDF></x:xmpmeta><?xpacket end="w"?>"#;

    #[test]
    fn every_form_is_read_and_comes_back() {
        let xmp = Xmp::parse(SIDECAR).unwrap();
        assert_eq!(xmp.text(XMP, "Rating").as_deref(), Some("4"));
        assert_eq!(xmp.text(PHOTOSHOP, "City").as_deref(), Some("Zürich & Umgebung"));
        assert_eq!(xmp.text(DC, "title").as_deref(), Some("Morning"));
        assert_eq!(xmp.get(DC, "subject").unwrap().texts(), ["fog", "lake"]);
        assert_eq!(xmp.text(LR, "hierarchicalSubject").as_deref(), Some("weather|fog"));
        let Some(Said::Parts(parts)) = xmp.get("http://example.com/own/", "place") else { panic!("{xmp:?}") };
        assert_eq!(parts.len(), 2);
        assert_eq!(Xmp::parse(&xmp.packet()), Ok(xmp));
    }

    #[test]
    fn what_is_no_xmp_is_told() {
        for text in ["", "<a/>", "<a", "\u{1}", "<!DOCTYPE a [<!ENTITY b \"c\">]><a>&b;</a>"] {
            assert!(Xmp::parse(text).is_err(), "{text}");
        }
        assert_eq!(Xmp::default().packet(), "");
    }

    #[test]
    fn values_in_values_without_end_are_cut() {
        let deep = format!("{}{}", "<o:a rdf:parseType=\"Resource\">".repeat(100), "</o:a>".repeat(100));
        let text = format!(
            "<rdf:RDF xmlns:rdf=\"{RDF}\" xmlns:o=\"urn:o\"><rdf:Description>{deep}</rdf:Description></rdf:RDF>"
        );
        assert!(Xmp::parse(&text).unwrap().packet().matches("<ns0:a").count() < 20);
    }

    #[test]
    fn a_text_cannot_break_the_packet() {
        let mut xmp = Xmp::default();
        xmp.set(DC, "source", Said::text("a\"<&>\u{1}\u{ffff}]]>.nef"));
        assert_eq!(Xmp::parse(&xmp.packet()).unwrap().text(DC, "source").unwrap(), "a\"<&>  ]]>.nef");
    }
}
