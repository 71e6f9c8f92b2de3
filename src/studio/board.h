// What a document shows, as the sections of docs/protocol.md. Each section knows when it changed last, so that every client gets
// what it has not seen and nothing else: there is no queue of states.
#pragma once

#include "ax/base.h"

typedef enum section {
    SECTION_TRIANGLES = 1,
    SECTION_HOLE_START = 2,
    SECTION_HOLE_HINGES = 3,
    SECTION_OPENING_START = 4,
    SECTION_OPENING_HINGES = 5,
    SECTION_ON_RIM = 6,
    SECTION_PANELS = 7,
    SECTION_NAMES = 8,
    SECTION_SHEET = 9,
    SECTION_FLAT = 16,
    SECTION_DEPLOYED = 17,
    SECTION_SIMULATED = 18,
    SECTION_PRESCRIBED = 20,
    SECTION_REALISED = 21,
    SECTION_OPENING = 22,
    SECTION_MATERIAL = 23,
    SECTION_MOUTH = 24,
    SECTION_RESIDUAL = 25,
    SECTION_CURVATURE = 26,
    SECTION_EDGE_FORCES = 27,
    SECTION_SUPPORTS = 28,
    SECTION_REACTIONS = 29,
    SECTION_VERTICES = 32,
    SECTION_FACES = 33,
    SECTION_VERTEX_CURVATURE = 34,
    SECTION_VERTEX_SCALE = 35,
    SECTION_PLACE = 40,
    SECTION_SHARE = 41,
    SECTION_TIMES = 42,
    SECTION_LIMIT = 48,
} section;

typedef enum section_type { SECTION_F32 = 1, SECTION_I32 = 2, SECTION_U8 = 3 } section_type;

typedef enum frame_kind { FRAME_STATE = 1, FRAME_SURFACE = 2, FRAME_MOTION = 3, FRAME_VARIANT = 4 } frame_kind;
enum { FRAME_SETTLED = 1, FRAME_EXACT = 2, FRAME_MOVING = 4, FRAME_PREVIEW = 8 };

typedef struct board_section {
    unsigned changed; // the board's stamp at its last change; 0: never filled
    section_type type;
    int count;
    size_t room; // bytes
    unsigned char* data;
} board_section;

typedef struct board {
    board_section sections[SECTION_LIMIT];
    unsigned stamp; // rises with every change
    unsigned topology, revision, flags;
} board;

void board_free(board* b);

// Fill a section, copying; where nothing differs from what it holds, nothing changes. `count` numbers.
void board_put_ints(board* b, section s, int count, const int* values);
void board_put_bytes(board* b, section s, int count, const unsigned char* values);
// Numbers in rows of `width`; `origin` (of that many numbers, NULL: none) is taken off in double precision.
void board_put_numbers(board* b, section s, int count, const double* values, int width, const double* origin);
// There is no such thing now.
void board_clear(board* b, section s, section_type type);

// What a frame says of itself beside the board's own numbers.
typedef struct frame_header {
    frame_kind kind;
    unsigned re, serial;
} frame_header;

// The frame of all sections that changed after stamp `seen` (0: all), owned by the caller, with `before` unused bytes in front of
// it for the transport. *size is without them.
unsigned char* board_frame(const board* b, frame_header header, unsigned seen, size_t before, size_t* size);
