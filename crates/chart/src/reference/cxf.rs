//! CxF 3 (ISO 17972): colours as XML.

use std::collections::HashMap;

use darkroot_colour::{Lab, Xyz};
use roxmltree::{Document, Node};

use super::ReferenceColour;
use super::{
    ImpossibleColour, NotAReference, Reference, ReferenceError, checked_lab, checked_reflectance, checked_xyz,
};

/// Elements inside elements, in no real file half as deep.
const MAX_DEPTH: usize = 64;
/// Attributes of one element.
const MAX_ATTRIBUTES: usize = 100;
/// Declarations of name spaces in the whole file.
const MAX_NAMESPACES: usize = 1000;

/// Reads every object that has a colour: its reflectance, else its XYZ, else its Lab.
pub(super) fn parse(text: &str) -> Result<Reference, ReferenceError> {
    // The reader of XML compares each attribute with all before it, and each element has the name spaces of those
    // around it. No `<` can stand in an attribute.
    let attributes = text.split('<').map(|element| element.matches('=').count()).max().unwrap_or(0);
    if attributes > MAX_ATTRIBUTES || text.matches("xmlns").count() > MAX_NAMESPACES {
        return Err(NotAReference::Crowded.into());
    }
    let document = Document::parse(text).map_err(NotAReference::Xml)?;
    let root = document.root_element();
    // What looks below elements takes a time that goes with the depth.
    if root.descendants().any(|n| n.ancestors().nth(MAX_DEPTH).is_some()) {
        return Err(NotAReference::Deep.into());
    }
    if root.tag_name().name() != "CxF" {
        return Err(NotAReference::OtherXml { element: root.tag_name().name().to_owned() }.into());
    }
    let ranges = ranges(&root);
    let objects = root.descendants().filter(|n| n.tag_name().name() == "Object");
    let mut patches = Vec::new();
    for (i, object) in objects.enumerate() {
        let name = object
            .attribute("Name")
            .or(object.attribute("Id"))
            .map_or_else(|| (i + 1).to_string(), str::to_owned);
        if let Some(colour) = colour(&ranges, &object, &name)? {
            patches.push((name, colour));
        }
    }
    if patches.is_empty() {
        return Err(ReferenceError::NoColours);
    }
    Ok(Reference { patches })
}

fn colour(
    ranges: &Ranges<'_>,
    object: &Node<'_, '_>,
    name: &str,
) -> Result<Option<ReferenceColour>, ReferenceError> {
    let find = |tag: &str| object.descendants().find(|n| n.tag_name().name() == tag);
    let number = |text: &str| {
        let value: Option<f64> = text.trim().parse().ok().filter(|v: &f64| v.is_finite());
        value.ok_or_else(|| ReferenceError::Number { patch: name.to_owned(), cell: text.trim().to_owned() })
    };
    if let Some(node) = find("ReflectanceSpectrum") {
        let values: Vec<f64> =
            node.text().unwrap_or_default().split_whitespace().map(number).collect::<Result<_, _>>()?;
        let (start, step) = range(ranges, &node).ok_or_else(|| ReferenceError::Colour {
            patch: name.to_owned(),
            fault: ImpossibleColour::NoWavelengths,
        })?;
        let wavelengths: Vec<f64> = (0..values.len()).map(|i| start + step * i as f64).collect();
        let scale = if values.iter().copied().fold(0.0, f64::max) > 2.0 { 0.01 } else { 1.0 };
        let values: Vec<f64> = values.iter().map(|v| v * scale).collect();
        return checked_reflectance(name, &wavelengths, &values).map(Some);
    }
    let triple = |node: &Node<'_, '_>, tags: [&str; 3]| -> Result<[f64; 3], ReferenceError> {
        let mut values = [0.0; 3];
        for (value, tag) in values.iter_mut().zip(tags) {
            let child = node.children().find(|n| n.tag_name().name() == tag);
            *value = number(child.and_then(|n| n.text()).unwrap_or_default())?;
        }
        Ok(values)
    };
    if let Some(node) = find("ColorCIEXYZ") {
        let [x, y, z] = triple(&node, ["X", "Y", "Z"])?;
        return checked_xyz(name, Xyz::new(x, y, z).scaled(0.01)).map(Some);
    }
    if let Some(node) = find("ColorCIELab") {
        let [l, a, b] = triple(&node, ["L", "A", "B"])?;
        return checked_lab(name, Lab { l, a, b }).map(Some);
    }
    Ok(None)
}

/// The WavelengthRange of each specification that has one, by its Id.
type Ranges<'a> = HashMap<&'a str, Node<'a, 'a>>;

fn ranges<'a>(root: &Node<'a, 'a>) -> Ranges<'a> {
    let mut ranges = HashMap::new();
    for specification in root.descendants().filter(|n| n.tag_name().name() == "ColorSpecification") {
        let range = specification.descendants().find(|n| n.tag_name().name() == "WavelengthRange");
        if let (Some(id), Some(range)) = (specification.attribute("Id"), range) {
            ranges.entry(id).or_insert(range);
        }
    }
    ranges
}

/// First wavelength and step, nm: on the spectrum itself or in the specification that it names.
fn range(ranges: &Ranges<'_>, spectrum: &Node<'_, '_>) -> Option<(f64, f64)> {
    let stated = spectrum.attribute("ColorSpecification").and_then(|id| ranges.get(id));
    let value = |name: &str| {
        let text = spectrum.attribute(name).or_else(|| stated.and_then(|n| n.attribute(name)));
        text.and_then(|t| t.parse::<f64>().ok())
    };
    Some((value("StartWL")?, value("Increment")?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(values: &str) -> String {
        format!(
            r#"<?xml version="1.0"?><cc:CxF xmlns:cc="http://colorexchangeformat.com/CxF3-core"><cc:Resources>
            <cc:ObjectCollection><cc:Object ObjectType="Standard" Name="A1" Id="1"><cc:ColorValues>{values}
            </cc:ColorValues></cc:Object></cc:ObjectCollection><cc:ColorSpecificationCollection>
            <cc:ColorSpecification Id="m1"><cc:MeasurementSpec><cc:WavelengthRange StartWL="380" Increment="10"/>
            </cc:MeasurementSpec></cc:ColorSpecification></cc:ColorSpecificationCollection></cc:Resources></cc:CxF>"#
        )
    }

    #[test]
    fn spectra_and_colours_are_read() {
        let spectrum = vec!["0.25"; 36].join(" ");
        let text = file(&format!(
            r#"<cc:ReflectanceSpectrum ColorSpecification="m1">{spectrum}</cc:ReflectanceSpectrum>"#
        ));
        let reference = Reference::parse(&text).unwrap();
        assert!((reference.patches[0].1.xyz_d50().y - 0.25).abs() < 1e-9);
        let lab = "<cc:ColorCIELab><cc:L>50</cc:L><cc:A>1</cc:A><cc:B>-2</cc:B></cc:ColorCIELab>";
        let reference = Reference::parse(&file(lab)).unwrap();
        assert_eq!(reference.patches[0].1, ReferenceColour::Lab(Lab { l: 50.0, a: 1.0, b: -2.0 }));
    }

    #[test]
    fn elements_inside_elements_and_crowds_of_attributes_are_refused() {
        let nested = |n: usize, inside: &str| {
            file(&format!("{}{inside}{}", "<cc:Object>".repeat(n), "</cc:Object>".repeat(n)))
        };
        let deep = NotAReference::Deep.into();
        assert_eq!(Reference::parse(&nested(300_000, "")), Err(deep));
        let many = format!("<cc:Object {}/>", (0..300_000).map(|i| format!("a{i}='' ")).collect::<String>());
        let crowded: ReferenceError = NotAReference::Crowded.into();
        assert_eq!(Reference::parse(&file(&many)), Err(crowded.clone()));
        let spaces = (0..300_000).map(|i| format!("<a xmlns:a{i}='b'>")).collect::<String>();
        assert_eq!(Reference::parse(&file(&spaces)), Err(crowded));
        // As many objects with as many specifications as the size allows, as deep as is allowed.
        let lab = "<cc:ColorCIELab><cc:L>50</cc:L><cc:A>1</cc:A><cc:B>-2</cc:B></cc:ColorCIELab>";
        let spectrum = "<cc:ReflectanceSpectrum ColorSpecification='x'/>";
        assert!(Reference::parse(&nested(MAX_DEPTH - 8, &"<cc:Other/>".repeat(300_000))).is_err());
        let broad = "<cc:Object/>".repeat(300_000) + lab;
        assert!(Reference::parse(&file(&broad)).is_ok());
        let broad = format!("<cc:Object>{spectrum}</cc:Object>").repeat(100_000);
        assert!(Reference::parse(&file(&broad)).is_err());
    }

    #[test]
    fn broken_files_are_named() {
        for (text, words) in [
            (file("<cc:ReflectanceSpectrum>0.1 0.2</cc:ReflectanceSpectrum>"), "start wavelength"),
            (
                file(
                    "<cc:ReflectanceSpectrum StartWL=\"400\" Increment=\"10\">0.1 x</cc:ReflectanceSpectrum>",
                ),
                "`x`",
            ),
            (
                file(
                    "<cc:ReflectanceSpectrum StartWL=\"400\" Increment=\"10\">0.1 0.2</cc:ReflectanceSpectrum>",
                ),
                "700 nm",
            ),
            (file(""), "an Object"),
            ("<html/>".to_owned(), "`html`"),
            ("<cc:CxF".to_owned(), "no reference file"),
        ] {
            let message = Reference::parse(&text).unwrap_err().to_string();
            assert!(message.contains(words), "{message}");
        }
    }
}
