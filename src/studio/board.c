#include "studio/board.h"

#include <stdint.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "frames are written as memory lies");
_Static_assert(sizeof(int) == 4 && sizeof(float) == 4, "sections hold numbers of four bytes");

enum { HEADER_WORDS = 8, SECTION_WORDS = 3 };
static const uint32_t magic = 0x31465841; // "AXF1"

void board_free(board* b)
{
    for (int s = 0; s < SECTION_LIMIT; ++s)
        ax_free(b->sections[s].data);
    *b = (board){0};
}

static size_t type_size(section_type type)
{
    return type == SECTION_U8 ? 1 : 4;
}

static size_t padded(size_t bytes)
{
    return (bytes + 3) & ~(size_t)3;
}

// Takes over `data` if it is not what the section holds already.
static void put(board* b, section s, section_type type, int count, const void* data)
{
    board_section* p = &b->sections[s];
    size_t bytes = (size_t)count * type_size(type);
    if (p->changed && p->type == type && p->count == count && (!bytes || memcmp(p->data, data, bytes) == 0))
        return;
    if (padded(bytes) > p->room) {
        ax_free(p->data);
        p->room = padded(bytes);
        p->data = ax_alloc(p->room, 1);
    }
    if (bytes) {
        memcpy(p->data, data, bytes);
        memset(p->data + bytes, 0, padded(bytes) - bytes);
    }
    p->type = type;
    p->count = count;
    p->changed = ++b->stamp;
}

void board_put_ints(board* b, section s, int count, const int* values)
{
    put(b, s, SECTION_I32, count, values);
}

void board_put_bytes(board* b, section s, int count, const unsigned char* values)
{
    put(b, s, SECTION_U8, count, values);
}

void board_put_numbers(board* b, section s, int count, const double* values, int width, const double* origin)
{
    float* single = AX_NEW(float, count);
    if (!origin)
        for (int k = 0; k < count; ++k)
            single[k] = (float)values[k];
    else
        for (int k = 0; k < count; k += width)
            for (int c = 0; c < width; ++c)
                single[k + c] = (float)(values[k + c] - origin[c]);
    put(b, s, SECTION_F32, count, single);
    ax_free(single);
}

void board_clear(board* b, section s, section_type type)
{
    put(b, s, type, 0, NULL);
}

unsigned char* board_frame(const board* b, frame_header header, unsigned seen, size_t before, size_t* size)
{
    uint32_t count = 0;
    size_t bytes = HEADER_WORDS * sizeof(uint32_t);
    for (int s = 0; s < SECTION_LIMIT; ++s) {
        const board_section* p = &b->sections[s];
        if (p->changed > seen) {
            ++count;
            bytes += SECTION_WORDS * sizeof(uint32_t) + padded((size_t)p->count * type_size(p->type));
        }
    }
    unsigned char *frame = ax_alloc(before + bytes, 1), *to = frame + before;
    const uint32_t head[HEADER_WORDS] = {magic,       (uint32_t)header.kind, header.re, b->topology,
                                         b->revision, header.serial,         b->flags,  count};
    to = (unsigned char*)memcpy(to, head, sizeof head) + sizeof head;
    for (int s = 0; s < SECTION_LIMIT; ++s) {
        const board_section* p = &b->sections[s];
        if (p->changed <= seen)
            continue;
        const uint32_t words[SECTION_WORDS] = {(uint32_t)s, (uint32_t)p->type, (uint32_t)p->count};
        to = (unsigned char*)memcpy(to, words, sizeof words) + sizeof words;
        size_t data = padded((size_t)p->count * type_size(p->type));
        if (data)
            memcpy(to, p->data, data);
        to += data;
    }
    *size = bytes;
    return frame;
}
