#include "fabricate/stroke_font.h"

#include <ctype.h>

// Strokes are separated by blanks, points are pairs of digits, x then y, on a grid of 4 by 6.
static const char* const glyphs[128] = {
    [' '] = "",
    ['%'] = "0046 0506161505 3031414030",
    ['\''] = "2625",
    ['('] = "36252130",
    [')'] = "16252110",
    ['+'] = "0343 2521",
    [','] = "2110",
    ['-'] = "0343",
    ['.'] = "2021",
    ['/'] = "0046",
    ['0'] = "100105163645413010 1135",
    ['1'] = "152620 1030",
    ['2'] = "05163645440040",
    ['3'] = "0516364544334241301001 1333",
    ['4'] = "30360242",
    ['5'] = "460604344341301001",
    ['6'] = "4536160501103041423303",
    ['7'] = "064610",
    ['8'] = "13040516364544331302011030414233",
    ['9'] = "0110304145361605041343",
    [':'] = "2122 2425",
    [';'] = "2110 2425",
    ['='] = "0242 0444",
    ['A'] = "0004264440 0242",
    ['B'] = "00063645443303 3342413000",
    ['C'] = "4536160501103041",
    ['D'] = "00062644422000",
    ['E'] = "46060040 0333",
    ['F'] = "460600 0333",
    ['G'] = "45361605011030414323",
    ['H'] = "0006 4046 0343",
    ['I'] = "1030 2026 1636",
    ['J'] = "4641301001",
    ['K'] = "0006 460340",
    ['L'] = "060040",
    ['M'] = "0006234640",
    ['N'] = "00064046",
    ['O'] = "100105163645413010",
    ['P'] = "00063645443303",
    ['Q'] = "100105163645413010 2240",
    ['R'] = "00063645443303 2340",
    ['S'] = "453616050413334241301001",
    ['T'] = "0646 2620",
    ['U'] = "060110304146",
    ['V'] = "062046",
    ['W'] = "0610233046",
    ['X'] = "0046 0640",
    ['Y'] = "062346 2320",
    ['Z'] = "06460040",
    ['_'] = "0040",
};
static const char box[] = "0006464000";

static const double cap = 6, width = 4, advance = 6; // grid units

static bool continues(char c) // the second and later bytes of a character
{
    return ((unsigned char)c & 0xc0) == 0x80;
}

static const char* glyph_of(char c)
{
    unsigned char code = (unsigned char)toupper((unsigned char)c);
    return code < 128 && glyphs[code] ? glyphs[code] : box;
}

double ax_stroke_width(const char* text)
{
    int letters = 0;
    for (; *text; ++text)
        letters += !continues(*text);
    return letters ? ((letters - 1) * advance + width) / cap : 0;
}

void ax_stroke_text(const char* text, void (*pen)(void* context, bool down, double x, double y), void* context)
{
    double x = 0;
    for (; *text; ++text) {
        if (continues(*text))
            continue;
        bool down = false;
        for (const char* at = glyph_of(*text); *at;)
            if (*at == ' ')
                down = false, ++at;
            else {
                pen(context, down, (x + (at[0] - '0')) / cap, (at[1] - '0') / cap);
                down = true, at += 2;
            }
        x += advance;
    }
}
