//! CxF 3 (ISO 17972): colours as XML.

use darkroot_colour::{Lab, Xyz};
use roxmltree::{Document, Node};

use super::ReferenceColour;
use super::{
    ImpossibleColour, NotAReference, Reference, ReferenceError, checked_lab, checked_reflectance, checked_xyz,
};

/// Reads every object that has a colour: its reflectance, else its XYZ, else its Lab.
pub(super) fn parse(text: &str) -> Result<Reference, ReferenceError> {
    let document = Document::parse(text).map_err(NotAReference::Xml)?;
    let root = document.root_element();
    if root.tag_name().name() != "CxF" {
        return Err(NotAReference::OtherXml { element: root.tag_name().name().to_owned() }.into());
    }
    let objects = root.descendants().filter(|n| n.tag_name().name() == "Object");
    let mut patches = Vec::new();
    for (i, object) in objects.enumerate() {
        let name = object
            .attribute("Name")
            .or(object.attribute("Id"))
            .map_or_else(|| (i + 1).to_string(), str::to_owned);
        if let Some(colour) = colour(&root, &object, &name)? {
            patches.push((name, colour));
        }
    }
    if patches.is_empty() {
        return Err(ReferenceError::NoColours);
    }
    Ok(Reference { patches })
}

fn colour(
    root: &Node<'_, '_>,
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
        let (start, step) = range(root, &node).ok_or_else(|| ReferenceError::Colour {
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

/// First wavelength and step, nm: on the spectrum itself or in the specification that it names.
fn range(root: &Node<'_, '_>, spectrum: &Node<'_, '_>) -> Option<(f64, f64)> {
    let wanted = spectrum.attribute("ColorSpecification");
    let specification = root.descendants().find(|n| {
        n.tag_name().name() == "ColorSpecification" && wanted.is_some() && n.attribute("Id") == wanted
    });
    let stated =
        specification.and_then(|s| s.descendants().find(|n| n.tag_name().name() == "WavelengthRange"));
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
