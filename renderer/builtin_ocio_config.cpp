// The text of the built-in OpenColorIO config, analytic throughout (no lookup table), for OpenColorIO 2.1 and later.
// Scene reference: linear Rec.709. Display reference: linear Rec.709 as the display emits it, 1 = its white, so that
// the views without an output transform pass no matrix.
#include "renderer/display.h"

namespace raytree {

// Shade as brightness: Phong 1973, appendix I, second table. LogAffine inverted: 10^((s - 1) / 0.5) = 10^(2 (s - 1)),
// a range of two densities (the paper gives no range).
// CRT: the same appendix compensates the tube with a power of about .33.
// Rec.709 to ACES2065-1 adapts D65 to the ACES white by Bradford; ACES SDR is OpenColorIO's own video output.
const std::string& builtin_ocio_config() {
  static const std::string text = R"config(ocio_profile_version: 2

environment:
  {}
search_path: ""
strictparsing: true
luma: [0.2126, 0.7152, 0.0722]
name: raytree-builtin-1
description: Raytree's built-in config, scene-linear Rec.709, analytic transforms only.

roles:
  aces_interchange: ACES2065-1
  cie_xyz_d65_interchange: CIE-XYZ-D65
  data: Raw
  default: Linear Rec.709
  reference: Linear Rec.709
  scene_linear: Linear Rec.709

file_rules:
  - !<Rule> {name: Default, colorspace: default}

shared_views:
  - !<View> {name: Standard, view_transform: Standard, display_colorspace: <USE_DISPLAY_NAME>}
  - !<View> {name: Shade as brightness, view_transform: Shade as brightness, display_colorspace: <USE_DISPLAY_NAME>}
  - !<View> {name: ACES SDR, view_transform: ACES SDR, display_colorspace: <USE_DISPLAY_NAME>}

displays:
  sRGB:
    - !<Views> [Standard, Shade as brightness, ACES SDR]
    - !<View> {name: Raw, colorspace: Raw}
  Rec.1886:
    - !<Views> [Standard, Shade as brightness, ACES SDR]
    - !<View> {name: Raw, colorspace: Raw}
  CRT:
    - !<Views> [Standard, Shade as brightness, ACES SDR]
    - !<View> {name: Raw, colorspace: Raw}

active_displays: [sRGB, Rec.1886, CRT]
active_views: [Standard, Shade as brightness, ACES SDR, Raw]

default_view_transform: Standard

view_transforms:
  - !<ViewTransform>
    name: Standard
    description: The scene's light as it is, clipped to what a display can show.
    from_scene_reference: !<RangeTransform> {min_in_value: 0, max_in_value: 1, min_out_value: 0, max_out_value: 1}

  - !<ViewTransform>
    name: Shade as brightness
    description: A shade s in [0, 1] is shown as 10^(2 (s - 1)), so that density is linear in s (Phong 1973, App. I).
    from_scene_reference: !<GroupTransform>
      children:
        - !<RangeTransform> {min_in_value: 0, max_in_value: 1, min_out_value: 0, max_out_value: 1}
        - !<LogAffineTransform> {base: 10, log_side_slope: 0.5, log_side_offset: 1, lin_side_slope: 1, lin_side_offset: 0, direction: inverse}

  - !<ViewTransform>
    name: ACES SDR
    description: ACES 1.0 output transform for SDR video.
    from_scene_reference: !<GroupTransform>
      children:
        - !<MatrixTransform> {matrix: [0.439632981919491, 0.382988698151554, 0.177378319928955, 0, 0.0897764429588424, 0.813439428748981, 0.0967841282921771, 0, 0.0175411703831727, 0.111546553302387, 0.87091227631444, 0, 0, 0, 0, 1]}
        - !<BuiltinTransform> {style: ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0}
        - !<MatrixTransform> {matrix: [3.24096994190452, -1.53738317757009, -0.498610760293003, 0, -0.96924363628088, 1.87596750150772, 0.0415550574071756, 0, 0.0556300796969936, -0.203976958888976, 1.05697151424288, 0, 0, 0, 0, 1]}
        - !<RangeTransform> {min_in_value: 0, max_in_value: 1, min_out_value: 0, max_out_value: 1}

display_colorspaces:
  - !<ColorSpace>
    name: sRGB
    family: Display
    bitdepth: 32f
    description: IEC 61966-2-1, the piecewise curve.
    encoding: sdr-video
    from_display_reference: !<ExponentWithLinearTransform> {gamma: 2.4, offset: 0.055, direction: inverse}

  - !<ColorSpace>
    name: Rec.1886
    family: Display
    bitdepth: 32f
    description: ITU-R BT.1886 with a black level of zero, exponent 2.4.
    encoding: sdr-video
    from_display_reference: !<ExponentTransform> {value: 2.4, direction: inverse}

  - !<ColorSpace>
    name: CRT
    family: Display
    bitdepth: 32f
    description: The tube of Phong 1973, App. I, compensated with the power .33.
    encoding: sdr-video
    from_display_reference: !<ExponentTransform> {value: 0.33}

  - !<ColorSpace>
    name: CIE-XYZ-D65
    family: Display
    bitdepth: 32f
    description: Tristimulus values relative to the display's white, D65.
    encoding: display-linear
    to_display_reference: !<MatrixTransform> {matrix: [3.24096994190452, -1.53738317757009, -0.498610760293003, 0, -0.96924363628088, 1.87596750150772, 0.0415550574071756, 0, 0.0556300796969936, -0.203976958888976, 1.05697151424288, 0, 0, 0, 0, 1]}

colorspaces:
  - !<ColorSpace>
    name: Linear Rec.709
    aliases: [lin_rec709, Linear Rec.709 (sRGB)]
    family: Linear
    bitdepth: 32f
    description: Scene-linear light, Rec.709 primaries, D65. What the renderer computes in.
    isdata: false
    encoding: scene-linear

  - !<ColorSpace>
    name: ACES2065-1
    aliases: [aces2065_1]
    family: ACES
    bitdepth: 32f
    description: ACES interchange, primaries AP0.
    isdata: false
    encoding: scene-linear
    from_scene_reference: !<MatrixTransform> {matrix: [0.439632981919491, 0.382988698151554, 0.177378319928955, 0, 0.0897764429588424, 0.813439428748981, 0.0967841282921771, 0, 0.0175411703831727, 0.111546553302387, 0.87091227631444, 0, 0, 0, 0, 1]}

  - !<ColorSpace>
    name: Raw
    family: Data
    bitdepth: 32f
    description: Values as they are.
    isdata: true
)config";
  return text;
}

}  // namespace raytree
