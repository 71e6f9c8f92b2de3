#include "picture/colour.h"

#include "base/vec.h"

enum { STOPS = 9 };

static const unsigned tide[STOPS] = {0x31357d, 0x2e5292, 0x216e9b, 0x24899e, 0x36a39b,
                                     0x62b88f, 0x9ac77c, 0xccd77a, 0xfbe786};
static const unsigned level[STOPS] = {0x17397b, 0x3064a4, 0x5990c7, 0x9ab8d8, 0xe4dcd6,
                                      0xe1ae8c, 0xdb7b40, 0xb0512b, 0x862919};
static const unsigned no_value = 0x9aa1ad;

// The stops are close enough to each other for straight lines in sRGB, which is what a browser's gradient draws too.
static void look_up(const unsigned stops[STOPS], double place, double rgb[3])
{
    bool known = !isnan(place);
    double t = known ? ax_clamp(place, 0, 1) * (STOPS - 1) : 0;
    int k = t < STOPS - 1 ? (int)t : STOPS - 2;
    unsigned low = known ? stops[k] : no_value, high = known ? stops[k + 1] : no_value;
    for (int c = 0, shift = 16; c < 3; ++c, shift -= 8) {
        double a = (low >> shift & 255) / 255.0, b = (high >> shift & 255) / 255.0;
        rgb[c] = a + (b - a) * (t - k);
    }
}

void ax_colour_scale(double lambda, double rgb[3])
{
    look_up(tide, lambda - 1, rgb);
}

void ax_colour_level(double value, double rgb[3])
{
    look_up(level, (value + 1) / 2, rgb);
}

void ax_palette_range(const ax_palette* palette, double range[2])
{
    bool scale = palette->kind == AX_PALETTE_SCALE, shade = palette->kind == AX_PALETTE_SHADE;
    range[0] = scale ? 1 : shade ? 0 : -palette->limit;
    range[1] = scale ? 2 : shade ? 1 : palette->limit;
}

void ax_palette_colour(const ax_palette* palette, double value, double rgb[3])
{
    if (palette->kind == AX_PALETTE_SCALE) {
        ax_colour_scale(value, rgb);
        return;
    }
    if (palette->kind == AX_PALETTE_SHADE) {
        ax_colour_scale(2 - value, rgb);
        return;
    }
    double place = value / palette->limit;
    if (palette->kind == AX_PALETTE_CURVATURE)
        place = place > 0 ? 0.1 + 0.9 * place : -0.4 + 0.6 * place;
    ax_colour_level(place, rgb);
}

bool ax_palette_hatched(const ax_palette* palette, double value)
{
    switch (palette->kind) {
    case AX_PALETTE_SCALE:
        return value < 0.995 || value > 2.005; // as it would be written with two decimals
    case AX_PALETTE_SHADE:
        return false;
    case AX_PALETTE_FORCE:
        return fabs(value) > palette->limit;
    case AX_PALETTE_CURVATURE:
        return value <= 0;
    }
    return false;
}

double ax_palette_limit(double x)
{
    static const double steps[] = {1, 2, 5, 6, 10};
    double power = pow(10, floor(log10(x)));
    int k = 0;
    while (k < 4 && steps[k] * power < x * (1 - 1e-9))
        ++k;
    return steps[k] * power;
}

double ax_colour_to_linear(double srgb)
{
    return srgb <= 0.04045 ? srgb / 12.92 : pow((srgb + 0.055) / 1.055, 2.4);
}

double ax_colour_from_linear(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}
