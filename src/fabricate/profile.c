// Machine profiles: which layer, colour and speed an operation gets. Colours follow what the makers' programs expect; there is no
// standard, so every sheet carries a legend.
#include "ax/fabricate.h"

#include <string.h>

// colours are three values and an index, which must be taken apart first
#define PEN(...) PEN_OF(__VA_ARGS__)
#define PEN_OF(name, r, g, b, index, width, mm_per_s)                                                                  \
    {                                                                                                                  \
        .layer = name, .rgb = {r, g, b}, .aci = index, .stroke = width, .speed = mm_per_s, .used = true                \
    }
#define BLACK 0, 0, 0, 7
#define RED   255, 0, 0, 1
#define BLUE  0, 0, 255, 5
#define GREY  128, 128, 128, 8

static const ax_profile profiles[] = {
    {.name = "generic",
     .doc = "red cuts, blue is marked, black is engraved",
     .pens = {PEN("LABEL", BLACK, 0.1, 100), PEN("SCORE", BLUE, 0.1, 60), PEN("HOLE", RED, 0.1, 15),
              PEN("SLIT", RED, 0.1, 15), PEN("CUT", RED, 0.1, 15), PEN("NOTE", GREY, 0.1, 0)},
     .travel_speed = 200},
    {.name = "lightburn",
     .doc = "LightBurn's layers C00 to C04 and the tool layer T1, by their exact colours",
     .pens = {PEN("C00 LABEL", BLACK, 0.1, 100), PEN("C01 SCORE", BLUE, 0.1, 60),
              PEN("C03 HOLE", 0, 224, 0, 3, 0.1, 15), PEN("C04 SLIT", 208, 208, 0, 2, 0.1, 15),
              PEN("C02 CUT", RED, 0.1, 15), PEN("T1 NOTE", 243, 105, 38, 30, 0.1, 0)},
     .travel_speed = 200},
    {.name = "trotec",
     .doc = "Trotec: red cuts, blue cuts lightly, black engraves; hair lines",
     .pens = {PEN("LABEL", BLACK, 0.01, 100), PEN("SCORE", BLUE, 0.01, 60), PEN("HOLE", RED, 0.01, 15),
              PEN("SLIT", RED, 0.01, 15), PEN("CUT", RED, 0.01, 15), PEN("NOTE", GREY, 0.01, 0)},
     .travel_speed = 400},
    {.name = "epilog",
     .doc = "Epilog: pure colours by colour mapping, lines of 0.001 inch",
     .pens = {PEN("LABEL", BLACK, 0.0254, 100), PEN("SCORE", BLUE, 0.0254, 60), PEN("HOLE", 0, 255, 0, 3, 0.0254, 15),
              PEN("SLIT", 255, 0, 255, 6, 0.0254, 15), PEN("CUT", RED, 0.0254, 15),
              PEN("NOTE", 255, 255, 0, 2, 0.0254, 0)},
     .travel_speed = 300},
    {.name = "uls",
     .doc = "Universal Laser Systems: eight pure colours; red cuts, blue marks, black engraves",
     .pens = {PEN("LABEL", BLACK, 0.0254, 100), PEN("SCORE", BLUE, 0.0254, 60), PEN("HOLE", 0, 255, 0, 3, 0.0254, 15),
              PEN("SLIT", 255, 0, 255, 6, 0.0254, 15), PEN("CUT", RED, 0.0254, 15),
              PEN("NOTE", 255, 255, 0, 2, 0.0254, 0)},
     .travel_speed = 300},
    {.name = "plotter",
     .doc = "knife or pen plotter: black draws, red cuts",
     .pens = {PEN("LABEL", BLACK, 0.25, 200), PEN("SCORE", BLACK, 0.25, 200), PEN("HOLE", RED, 0.25, 60),
              PEN("SLIT", RED, 0.25, 60), PEN("CUT", RED, 0.25, 60), PEN("NOTE", GREY, 0.25, 0)},
     .travel_speed = 400},
};

const ax_profile* ax_profiles(int* count)
{
    *count = (int)(sizeof profiles / sizeof *profiles);
    return profiles;
}
