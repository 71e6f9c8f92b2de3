#include "inspect.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const char cut_off[] = "The file may have been cut off: export or copy it again.";

static bool fault(inspection* found, const char* format, ...) __attribute__((format(printf, 2, 3)));

static bool fault(inspection* found, const char* format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(found->message, sizeof found->message, format, arguments);
    va_end(arguments);
    return false;
}

// --- words and numbers -----------------------------------------------------------------------------------------------

typedef struct span {
    const char *at, *end;
} span;

typedef struct text {
    span rest;
    long line; // number of the line taken last, from 1
    char newline;
} text;

static text text_of(span data)
{
    bool usual = memchr(data.at, '\n', (size_t)(data.end - data.at));
    return (text){data, 0, usual ? '\n' : '\r'};
}

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool next_line(text* t, span* line)
{
    if (t->rest.at == t->rest.end)
        return false;
    const char* end = memchr(t->rest.at, t->newline, (size_t)(t->rest.end - t->rest.at));
    *line = (span){t->rest.at, end ? end : t->rest.end};
    t->rest.at = end ? end + 1 : t->rest.end;
    ++t->line;
    return true;
}

static bool next_word(span* line, span* word)
{
    const char* at = line->at;
    while (at < line->end && is_space(*at))
        ++at;
    word->at = at;
    while (at < line->end && !is_space(*at))
        ++at;
    word->end = line->at = at;
    return word->at < at;
}

static size_t length(span s)
{
    return (size_t)(s.end - s.at);
}

static bool is(span word, const char* expected)
{
    return length(word) == strlen(expected) && strncasecmp(word.at, expected, length(word)) == 0;
}

static int shown(span word) // for %.*s
{
    return length(word) < 40 ? (int)length(word) : 40;
}

static bool is_number(span word)
{
    const char *at = word.at, *end = word.end;
    if (at < end && (*at == '+' || *at == '-'))
        ++at;
    int digits = 0;
    while (at < end && is_digit(*at))
        ++at, ++digits;
    if (at < end && *at == '.')
        ++at;
    while (at < end && is_digit(*at))
        ++at, ++digits;
    if (digits && at < end && (*at == 'e' || *at == 'E')) {
        ++at;
        if (at < end && (*at == '+' || *at == '-'))
            ++at;
        if (at == end)
            return false;
        while (at < end && is_digit(*at))
            ++at;
    }
    return digits && at == end;
}

static bool is_infinite_or_nan(span word)
{
    if (word.at < word.end && (*word.at == '+' || *word.at == '-'))
        ++word.at;
    return length(word) >= 3 && (strncasecmp(word.at, "nan", 3) == 0 || strncasecmp(word.at, "inf", 3) == 0);
}

// A whole number at the beginning of the word; saturates, which is out of any range it is compared with.
static bool leading_integer(span word, int64_t* value)
{
    const char* at = word.at;
    bool negative = at < word.end && *at == '-';
    at += negative;
    if (at == word.end || !is_digit(*at))
        return false;
    int64_t sum = 0;
    for (; at < word.end && is_digit(*at); ++at)
        sum = sum < INT64_MAX / 20 ? 10 * sum + (*at - '0') : sum;
    *value = negative ? -sum : sum;
    return true;
}

// In OBJ a line that ends in a backslash goes on in the next: it is left to the importer.
static bool goes_on(span word)
{
    return length(word) == 1 && *word.at == '\\';
}

// Three coordinates from a line.
static bool check_point(span* line, long number, inspection* found)
{
    for (int d = 0; d < 3; ++d) {
        span word;
        if (!next_word(line, &word))
            return fault(found, "Line %ld gives %d of 3 coordinates. %s", number, d, cut_off);
        if (goes_on(word))
            return true;
        if (is_infinite_or_nan(word))
            return fault(found,
                         "Line %ld has a vertex at no finite place (%.*s). Delete the vertex and its faces, or give it "
                         "coordinates.",
                         number, shown(word), word.at);
        if (!is_number(word))
            return fault(found, "Line %ld: '%.*s' is not a number. Mend the line, or export the mesh again.", number,
                         shown(word), word.at);
    }
    return true;
}

// --- OBJ -------------------------------------------------------------------------------------------------------------

typedef struct obj {
    int64_t vertices, faces;
    int64_t highest; // vertex any face refers to, and where
    long highest_line;
} obj;

static bool check_obj_face(span line, long number, obj* seen, inspection* found)
{
    int corners = 0;
    for (span word; next_word(&line, &word); ++corners) {
        if (goes_on(word)) {
            ++seen->faces;
            return true;
        }
        int64_t vertex;
        if (*word.at == '#')
            break;
        if (!leading_integer(word, &vertex) || vertex == 0)
            return fault(found, "Line %ld: '%.*s' names no vertex; they are counted from 1. Export the mesh again.",
                         number, shown(word), word.at);
        if (vertex < 0 && -vertex > seen->vertices)
            return fault(found,
                         "Line %ld: a face refers to vertex %lld, but only %lld come before it. Export the mesh again.",
                         number, (long long)vertex, (long long)seen->vertices);
        if (vertex > seen->highest) {
            seen->highest = vertex;
            seen->highest_line = number;
        }
    }
    if (corners < 3)
        return fault(found, "Line %ld: a face needs at least 3 corners, this one has %d. %s", number, corners, cut_off);
    ++seen->faces;
    return true;
}

static bool inspect_obj(span data, inspection* found)
{
    text t = text_of(data);
    obj seen = {0};
    for (span line; next_line(&t, &line);) {
        span word;
        if (!next_word(&line, &word) || length(word) != 1)
            continue;
        if (*word.at == 'v') {
            ++seen.vertices;
            if (!check_point(&line, t.line, found))
                return false;
        } else if (*word.at == 'f' && !check_obj_face(line, t.line, &seen, found)) {
            return false;
        }
    }
    if (!seen.faces)
        return fault(
            found,
            "There are no faces in it: of %ld lines, %lld give vertices (v x y z) and none a face (f 1 2 3). Export a "
            "surface of triangles or polygons as OBJ.",
            t.line, (long long)seen.vertices);
    if (seen.highest > seen.vertices)
        return fault(found, "Line %ld: a face refers to vertex %lld, but the file has %lld. %s", seen.highest_line,
                     (long long)seen.highest, (long long)seen.vertices, cut_off);
    return true;
}

// --- STL -------------------------------------------------------------------------------------------------------------

static bool inspect_stl_text(span data, inspection* found)
{
    text t = text_of(data);
    int64_t facets = 0;
    int corners = -1; // -1 outside a facet
    bool ended = false;
    for (span line; next_line(&t, &line);)
        for (span word; next_word(&line, &word);) {
            if (is(word, "solid") || is(word, "endsolid")) {
                ended = is(word, "endsolid");
                break; // a name follows
            }
            if (is(word, "facet")) {
                corners = 0;
            } else if (is(word, "vertex") && corners >= 0) {
                ++corners;
                if (!check_point(&line, t.line, found))
                    return false;
            } else if (is(word, "endfacet")) {
                if (corners != 3)
                    return fault(found,
                                 "Line %ld: the facet that ends here has %d corners, not 3. Export the mesh again.",
                                 t.line, corners < 0 ? 0 : corners);
                ++facets;
                corners = -1;
            }
        }
    if (!facets && corners < 0)
        return fault(found, "There are no facets in its %ld lines. Export a surface of triangles as STL.", t.line);
    if (corners >= 0 || !ended)
        return fault(found, "It breaks off after %lld facets, in line %ld, without 'endsolid'. %s", (long long)facets,
                     t.line, cut_off);
    return true;
}

static bool inspect_stl(span data, inspection* found)
{
    size_t size = length(data), header = 84;
    uint32_t facets = 0;
    if (size >= header)
        memcpy(&facets, data.at + 80, sizeof facets); // little-endian, like the machines this runs on
    uint64_t expected = header + 50 * (uint64_t)facets;
    if (size >= header && expected == size) {
        if (!facets)
            return fault(found, "It declares 0 facets. Export a surface of triangles as STL.");
        return true;
    }
    span start = {data.at, data.at + (size < 1024 ? size : 1024)}, line = start, word;
    if (!memchr(start.at, 0, length(start)) && next_word(&line, &word) && length(word) >= 5 &&
        strncasecmp(word.at, "solid", 5) == 0)
        return inspect_stl_text(data, found);
    if (size < header || !memchr(start.at, 0, length(start)))
        return fault(
            found,
            "It is no STL file: a text file begins with 'solid', a binary one has a header of 84 bytes that declares "
            "its size. Export a surface of triangles as STL.");
    return fault(found, "Its header declares %u facets, which take %llu bytes, but it has %zu. %s", facets,
                 (unsigned long long)expected, size, cut_off);
}

// --- PLY -------------------------------------------------------------------------------------------------------------

typedef enum ply_format { ply_unknown, ply_text, ply_little, ply_big } ply_format;

typedef struct ply_type {
    const char *name, *other;
    int size;
    bool is_signed, real;
} ply_type;

static const ply_type ply_types[] = {
    {"char", "int8", 1, true, false},      {"uchar", "uint8", 1, false, false},  {"short", "int16", 2, true, false},
    {"ushort", "uint16", 2, false, false}, {"int", "int32", 4, true, false},     {"uint", "uint32", 4, false, false},
    {"float", "float32", 4, true, true},   {"double", "float64", 8, true, true},
};

enum { ply_most_elements = 16, ply_most_properties = 64 };

typedef struct ply_property {
    const ply_type *type, *count; // count: NULL unless it is a list
    bool corners;                 // the list of a face's vertices
} ply_property;

typedef struct ply_element {
    char name[32];
    int64_t count;
    int property_count;
    ply_property properties[ply_most_properties];
} ply_element;

typedef struct ply {
    ply_format format;
    int element_count;
    ply_element elements[ply_most_elements];
    int64_t vertices, faces;
} ply;

static const ply_type* find_ply_type(span word)
{
    for (size_t i = 0; i < sizeof ply_types / sizeof *ply_types; ++i)
        if (is(word, ply_types[i].name) || is(word, ply_types[i].other))
            return &ply_types[i];
    return NULL;
}

static bool bad_header(long line, inspection* found)
{
    return fault(found, "Line %ld of its header is not understood. Export the mesh as PLY again.", line);
}

static bool read_ply_element(span line, long number, ply* p, inspection* found)
{
    span name, count;
    if (p->element_count == ply_most_elements || !next_word(&line, &name) || !next_word(&line, &count))
        return bad_header(number, found);
    ply_element* element = &p->elements[p->element_count++];
    snprintf(element->name, sizeof element->name, "%.*s", shown(name), name.at);
    if (!leading_integer(count, &element->count) || element->count < 0)
        return bad_header(number, found);
    if (is(name, "vertex"))
        p->vertices = element->count;
    if (is(name, "face") || is(name, "tristrips"))
        p->faces = element->count;
    return true;
}

static bool read_ply_property(span line, long number, ply* p, inspection* found)
{
    span word, name;
    if (!p->element_count || !next_word(&line, &word))
        return bad_header(number, found);
    ply_element* element = &p->elements[p->element_count - 1];
    if (element->property_count == ply_most_properties)
        return bad_header(number, found);
    ply_property* property = &element->properties[element->property_count++];
    if (is(word, "list")) {
        if (!next_word(&line, &word) || !(property->count = find_ply_type(word)) || property->count->real ||
            !next_word(&line, &word))
            return bad_header(number, found);
    }
    property->type = find_ply_type(word);
    if (!property->type || !next_word(&line, &name))
        return bad_header(number, found);
    property->corners = property->count && !property->type->real && strcmp(element->name, "face") == 0 &&
                        (is(name, "vertex_indices") || is(name, "vertex_index"));
    return true;
}

static bool read_ply_header(text* t, ply* p, inspection* found)
{
    span line, word;
    if (!next_line(t, &line) || !next_word(&line, &word) || !is(word, "ply"))
        return fault(found,
                     "It is no PLY file, which begins with the line 'ply'. Export a surface of triangles as PLY.");
    while (next_line(t, &line)) {
        if (!next_word(&line, &word) || is(word, "comment") || is(word, "obj_info"))
            continue;
        if (is(word, "end_header"))
            return true;
        if (is(word, "format") && next_word(&line, &word)) {
            p->format = is(word, "ascii")                  ? ply_text
                        : is(word, "binary_little_endian") ? ply_little
                        : is(word, "binary_big_endian")    ? ply_big
                                                           : ply_unknown;
        } else if (is(word, "element")) {
            if (!read_ply_element(line, t->line, p, found))
                return false;
        } else if (is(word, "property")) {
            if (!read_ply_property(line, t->line, p, found))
                return false;
        } else {
            return bad_header(t->line, found);
        }
    }
    return fault(found, "Its header breaks off in line %ld, without 'end_header'. %s", t->line, cut_off);
}

static bool ply_breaks_off(const ply_element* element, int64_t present, inspection* found)
{
    return fault(found, "Its header declares %lld of element '%s', but the file ends after %lld. %s",
                 (long long)element->count, element->name, (long long)present, cut_off);
}

static bool no_such_corner(int64_t face, int64_t vertex, int64_t count, inspection* found)
{
    return fault(
        found,
        "Face %lld (counted from 0) refers to vertex %lld, but there are %lld, counted from 0. Export the mesh again.",
        (long long)face, (long long)vertex, (long long)count);
}

static bool check_ply_row(const ply* p, const ply_element* element, int64_t row, span line, long number,
                          inspection* found)
{
    bool vertex = strcmp(element->name, "vertex") == 0;
    for (int i = 0; i < element->property_count; ++i) {
        const ply_property* property = &element->properties[i];
        span word;
        int64_t count = 1;
        if (property->count && (!next_word(&line, &word) || !leading_integer(word, &count) || count < 0))
            return fault(found, "Line %ld does not begin with the length of a list. %s", number, cut_off);
        for (int64_t k = 0; k < count; ++k) {
            int64_t index;
            if (!next_word(&line, &word))
                return fault(found, "Line %ld has fewer numbers than its header declares. %s", number, cut_off);
            if (vertex && is_infinite_or_nan(word))
                return fault(found, "Line %ld has a vertex at no finite place (%.*s). Delete the vertex and its faces.",
                             number, shown(word), word.at);
            if (!is_number(word) && !is_infinite_or_nan(word))
                return fault(found, "Line %ld: '%.*s' is not a number. Mend the line, or export the mesh again.",
                             number, shown(word), word.at);
            if (property->corners && leading_integer(word, &index) && (index < 0 || index >= p->vertices))
                return no_such_corner(row, index, p->vertices, found);
        }
    }
    return true;
}

static bool inspect_ply_text(text* t, const ply* p, inspection* found)
{
    for (int e = 0; e < p->element_count; ++e) {
        const ply_element* element = &p->elements[e];
        for (int64_t row = 0; row < element->count; ++row) {
            span line, ahead, word;
            do {
                if (!next_line(t, &line))
                    return ply_breaks_off(element, row, found);
                ahead = line;
            } while (!next_word(&ahead, &word));
            if (!check_ply_row(p, element, row, line, t->line, found))
                return false;
        }
    }
    return true;
}

static int64_t ply_integer(const char* at, const ply_type* type, bool big)
{
    uint64_t value = 0;
    for (int i = 0; i < type->size; ++i)
        value |= (uint64_t)(unsigned char)at[big ? type->size - 1 - i : i] << (8 * i);
    uint64_t sign = (uint64_t)1 << (8 * type->size - 1);
    return type->is_signed && (value & sign) ? (int64_t)(value - sign) - (int64_t)sign : (int64_t)value;
}

static bool inspect_ply_binary(span rest, const ply* p, inspection* found)
{
    bool big = p->format == ply_big;
    for (int e = 0; e < p->element_count; ++e) {
        const ply_element* element = &p->elements[e];
        if (!element->property_count)
            continue;
        for (int64_t row = 0; row < element->count; ++row)
            for (int i = 0; i < element->property_count; ++i) {
                const ply_property* property = &element->properties[i];
                int64_t count = 1, size = property->type->size;
                if (property->count) {
                    if (length(rest) < (size_t)property->count->size)
                        return ply_breaks_off(element, row, found);
                    count = ply_integer(rest.at, property->count, big);
                    rest.at += property->count->size;
                }
                if (count < 0 || count > (int64_t)length(rest) / size)
                    return ply_breaks_off(element, row, found);
                for (int64_t k = 0; property->corners && k < count; ++k) {
                    int64_t index = ply_integer(rest.at + k * size, property->type, big);
                    if (index < 0 || index >= p->vertices)
                        return no_such_corner(row, index, p->vertices, found);
                }
                rest.at += count * size;
            }
    }
    return true;
}

static bool inspect_ply(span data, inspection* found)
{
    text t = text_of(data);
    ply p = {0};
    if (!read_ply_header(&t, &p, found))
        return false;
    if (!p.faces)
        return fault(
            found, "Its header declares %lld vertices but no faces. Export a surface of triangles or polygons as PLY.",
            (long long)p.vertices);
    switch (p.format) {
    case ply_text:
        return inspect_ply_text(&t, &p, found);
    case ply_little:
    case ply_big:
        return inspect_ply_binary(t.rest, &p, found);
    case ply_unknown:
        break;
    }
    return fault(found, "Its header declares neither text nor binary format. Export the mesh as PLY again.");
}

// --- OFF -------------------------------------------------------------------------------------------------------------

// The next line that is not empty, without its comment.
static bool next_off_line(text* t, span* line)
{
    while (next_line(t, line)) {
        const char* comment = memchr(line->at, '#', length(*line));
        line->end = comment ? comment : line->end;
        span ahead = *line, word;
        if (next_word(&ahead, &word))
            return true;
    }
    return false;
}

static bool check_off_face(span line, long number, int64_t face, int64_t vertices, inspection* found)
{
    span word;
    int64_t corners, vertex;
    if (!next_word(&line, &word) || !leading_integer(word, &corners) || corners < 1)
        return fault(found, "Line %ld does not begin with the number of a face's corners. Export the mesh again.",
                     number);
    for (int64_t k = 0; k < corners; ++k) {
        if (!next_word(&line, &word) || !leading_integer(word, &vertex))
            return fault(found, "Line %ld declares a face of %lld corners and has %lld. %s", number, (long long)corners,
                         (long long)k, cut_off);
        if (vertex < 0 || vertex >= vertices)
            return no_such_corner(face, vertex, vertices, found);
    }
    return true;
}

static bool inspect_off(span data, inspection* found)
{
    text t = text_of(data);
    span line, word;
    if (!next_off_line(&t, &line) || !next_word(&line, &word) || length(word) < 3 ||
        strncasecmp(word.end - 3, "off", 3) != 0)
        return fault(found, "It is no OFF file, which begins with 'OFF'. Export a surface of triangles as OFF.");
    if (memchr(word.at, '4', length(word)) || memchr(word.at, 'n', length(word)))
        return true; // other dimensions than three: the importer decides
    int64_t counts[2];
    for (int i = 0; i < 2; ++i) {
        while (!next_word(&line, &word))
            if (!next_off_line(&t, &line))
                return fault(found, "It breaks off before the numbers of vertices and faces, in line %ld. %s", t.line,
                             cut_off);
        if (i == 0 && is(word, "binary"))
            return true;
        if (!leading_integer(word, &counts[i]) || counts[i] < 0)
            return fault(found,
                         "Line %ld should give the numbers of vertices and faces, not '%.*s'. Export the mesh again.",
                         t.line, shown(word), word.at);
    }
    if (!counts[1])
        return fault(found, "It declares %lld vertices but no faces. Export a surface of triangles or polygons as OFF.",
                     (long long)counts[0]);
    for (int64_t v = 0; v < counts[0]; ++v) {
        if (!next_off_line(&t, &line))
            return fault(found, "It declares %lld vertices, but ends after %lld. %s", (long long)counts[0],
                         (long long)v, cut_off);
        if (!check_point(&line, t.line, found))
            return false;
    }
    for (int64_t f = 0; f < counts[1]; ++f) {
        if (!next_off_line(&t, &line))
            return fault(found, "It declares %lld faces, but ends after %lld. %s", (long long)counts[1], (long long)f,
                         cut_off);
        if (!check_off_face(line, t.line, f, counts[0], found))
            return false;
    }
    return true;
}

bool inspect(const char* name, const char* data, size_t size, inspection* found)
{
    static const struct {
        const char* ending;
        bool (*inspect)(span data, inspection* found);
    } formats[] = {{".obj", inspect_obj}, {".stl", inspect_stl}, {".ply", inspect_ply}, {".off", inspect_off}};
    found->message[0] = 0;
    const char* ending = strrchr(name, '.');
    for (size_t i = 0; ending && i < sizeof formats / sizeof *formats; ++i)
        if (strcasecmp(ending, formats[i].ending) == 0)
            return formats[i].inspect((span){data, data + size}, found);
    return true;
}
