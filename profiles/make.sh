#!/bin/sh
# Makes the profiles of this folder from published spectral sensitivities, byte for byte. Run from the top of the
# repository with the folder of spectra and, if need be, the program:
#   profiles/make.sh SPECTRA [target/release/darkroot] [FOLDER]
# The sensitivities and 190 of the reflectances are those of rawtoaces (Academy Software Foundation, Apache-2.0), the
# other reflectances those of ISETCam (MIT). The spectra themselves are not in this repository.
set -eu
spectra="$1"
darkroot="${2:-target/release/darkroot}"
folder="${3:-profiles}"

# make SPECTRA-NAME FILE MAKE MODEL [ALIAS...]
make() {
    source="$1"; file="$2"; maker="$3"; model="$4"
    shift 4
    for alias in "$@"; do set -- "$@" --alias "$alias"; shift; done
    "$darkroot" profile from-spectra -q --overwrite --sensitivities "$spectra/cam_rawtoaces_$source.csv" \
        --make "$maker" --camera-model "$model" "$@" --light D65 D50 A --model spectral --date 2026-11-22 \
        --reflectances "$spectra/refl_rawtoaces190.csv" "$spectra/refl_iset_clothes_vhrel.csv" \
        "$spectra/refl_iset_dupontpaintchip_vhrel.csv" "$spectra/refl_iset_food_vhrel.csv" \
        "$spectra/refl_iset_hair_vhrel.csv" "$spectra/refl_iset_munsellsamples_vhrel.csv" \
        "$spectra/refl_iset_nature_vhrel.csv" "$spectra/refl_iset_objects_vhrel.csv" \
        "$spectra/refl_iset_africanamerican_vhrel.csv" "$spectra/refl_iset_caucasian_vhrel.csv" \
        "$spectra/refl_iset_eastindian_vhrel.csv" "$spectra/refl_iset_macbethchart.csv" \
        --held-out "$spectra/refl_iset_esserchart.csv" "$spectra/refl_iset_gretagdigitalcolorsg.csv" \
        -o "$folder/$file.toml"
}

make arri_d21 arri/d-21 ARRI D-21 "ARRI D21" "ARRI ARRIFLEX D-21"
make canon_eos_5d_mark_ii canon/eos-5d-mark-ii Canon "EOS 5D Mark II" "Canon Canon EOS 5D Mark II"
make canon_xti canon/eos-400d Canon "EOS 400D" "Canon EOS 400D DIGITAL" "Canon Canon EOS 400D DIGITAL" \
    "Canon Canon EOS DIGITAL REBEL XTi" "Canon EOS Digital Rebel XTi" "Canon EOS Kiss Digital X" \
    "Canon Canon EOS Kiss Digital X"
make canon_powershot_s90 canon/powershot-s90 Canon "PowerShot S90" "Canon Canon PowerShot S90"
make nikon_d70 nikon/d70 Nikon D70 "NIKON CORPORATION NIKON D70"
make nikon_d200 nikon/d200 Nikon D200 "NIKON CORPORATION NIKON D200"
make nikon_d700 nikon/d700 Nikon D700 "NIKON CORPORATION NIKON D700"
make nikon_d5100 nikon/d5100 Nikon D5100 "NIKON CORPORATION NIKON D5100"
make nikon_d7000 nikon/d7000 Nikon D7000 "NIKON CORPORATION NIKON D7000"
make sony_ilce-7rm2 sony/ilce-7rm2 Sony ILCE-7RM2 "Sony A7R II" "Sony Alpha 7R II"
make sony_ilce-7sm2 sony/ilce-7sm2 Sony ILCE-7SM2 "Sony A7S II" "Sony Alpha 7S II"
