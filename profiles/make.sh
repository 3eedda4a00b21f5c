#!/bin/sh
# Makes the profiles of this folder from published spectral sensitivities, byte for byte. Run from the top of the
# repository with the folder of spectra and, if need be, the program:
#   profiles/make.sh SPECTRA [target/release/darkroot] [FOLDER]
# The sensitivities are those of rawtoaces (Academy Software Foundation, Apache-2.0; see NOTICE), sampled every 10 nm. They
# are judged by two charts of ISETCam (MIT) that are not among the surfaces built into the program. The spectra themselves
# are not in this repository.
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
        --make "$maker" --camera-model "$model" "$@" --light D65 D50 A --date 2026-11-26 \
        --held-out "$spectra/refl_iset_esserchart.csv" "$spectra/refl_iset_gretagdigitalcolorsg.csv" \
        -o "$folder/$file.toml"
}

# Canon writes its name into the model, too.
canon() {
    source="$1"; file="$2"; model="$3"
    shift 3
    for alias in "$model" "$@"; do set -- "$@" "Canon Canon $alias"; done
    make "canon_$source" "canon/$file" Canon "$model" "$@"
}

# Nikon has two names, and writes one of them into the model, too.
nikon() {
    make "nikon_$1" "nikon/$2" Nikon "$3" "NIKON CORPORATION NIKON $3"
}

sony() {
    source="$1"; model="$2"
    shift 2
    make "sony_$source" "sony/$source" Sony "$model" "$@"
}

make arashi_vision_insta360_x5 arashi-vision/insta360-x5 "Arashi Vision" "Insta360 X5"
make arri_d21 arri/d-21 ARRI D-21 "ARRI D21" "ARRI ARRIFLEX D-21"

canon eos-1d_x_mark_ii eos-1d-x-mark-ii "EOS-1D X Mark II"
canon eos-1ds_mark_ii eos-1ds-mark-ii "EOS-1Ds Mark II"
canon eos-1ds_mark_iii eos-1ds-mark-iii "EOS-1Ds Mark III"
canon eos_100d eos-100d "EOS 100D" "EOS REBEL SL1" "EOS Kiss X7"
canon eos_200d eos-200d "EOS 200D" "EOS REBEL SL2" "EOS Kiss X9"
canon eos_200d_ii eos-250d "EOS 250D" "EOS 200D II" "EOS REBEL SL3" "EOS Kiss X10"
canon eos_5d eos-5d "EOS 5D"
canon eos_5d_mark_ii eos-5d-mark-ii "EOS 5D Mark II"
canon eos_5d_mark_iii eos-5d-mark-iii "EOS 5D Mark III"
canon eos_5d_mark_iv eos-5d-mark-iv "EOS 5D Mark IV"
canon eos_5ds eos-5ds "EOS 5DS"
canon eos_600d eos-600d "EOS 600D" "EOS REBEL T3i" "EOS Kiss X5"
canon eos_m eos-m "EOS M"
canon eos_r eos-r "EOS R"
canon eos_r10 eos-r10 "EOS R10"
canon eos_r5 eos-r5 "EOS R5"
canon eos_r5m2 eos-r5-mark-ii "EOS R5 Mark II" "EOS R5m2"
canon eos_r6 eos-r6 "EOS R6"
canon eos_r6m2 eos-r6-mark-ii "EOS R6 Mark II" "EOS R6m2"
canon eos_rp eos-rp "EOS RP"
canon powershot_s90 powershot-s90 "PowerShot S90"
canon xti eos-400d "EOS 400D" "EOS 400D DIGITAL" "EOS DIGITAL REBEL XTi" "EOS Kiss Digital X"

make fujifilm_gfx_100 fujifilm/gfx-100 Fujifilm "GFX 100" "Fujifilm GFX100"
make fujifilm_x-t3 fujifilm/x-t3 Fujifilm X-T3
make fujifilm_x-t4 fujifilm/x-t4 Fujifilm X-T4

make hasselblad_l1d-20c hasselblad/l1d-20c Hasselblad L1D-20c "DJI L1D-20c"
make hasselblad_l2d-20c hasselblad/l2d-20c Hasselblad L2D-20c "DJI L2D-20c"

nikon d70 d70 D70
nikon d200 d200 D200
nikon d700 d700 D700
nikon d800e d800e D800E
nikon d810 d810 D810
nikon d850 d850 D850
nikon d3300 d3300 D3300
nikon d5100 d5100 D5100
nikon d5300 d5300 D5300
nikon d7000 d7000 D7000
nikon z_f z-f "Z f"

make panasonic_dc-gx9 panasonic/dc-gx9 Panasonic DC-GX9 "Panasonic DC-GX7MK3" "Panasonic DC-GX9K"

sony dsc-rx100m4 DSC-RX100M4 "Sony RX100 IV"
sony ilce-6400 ILCE-6400 "Sony Alpha 6400"
sony ilce-7cm2 ILCE-7CM2 "Sony A7C II" "Sony Alpha 7C II"
sony ilce-7m3 ILCE-7M3 "Sony A7 III" "Sony Alpha 7 III"
sony ilce-7m4 ILCE-7M4 "Sony A7 IV" "Sony Alpha 7 IV"
sony ilce-7rm2 ILCE-7RM2 "Sony A7R II" "Sony Alpha 7R II"
sony ilce-7rm3 ILCE-7RM3 "Sony A7R III" "Sony Alpha 7R III"
sony ilce-7rm4 ILCE-7RM4 "Sony A7R IV" "Sony Alpha 7R IV"
sony ilce-7sm2 ILCE-7SM2 "Sony A7S II" "Sony Alpha 7S II"
sony ilce-7sm3 ILCE-7SM3 "Sony A7S III" "Sony Alpha 7S III"
sony ilce-9 ILCE-9 "Sony A9" "Sony Alpha 9"
