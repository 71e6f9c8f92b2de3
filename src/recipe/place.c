#include "recipe/place.h"

#include <string.h>

static const char* skip_space(const char* at)
{
    return at + strspn(at, " \t\r\n");
}

static const char* skip_string(const char* at)
{
    for (++at; *at && *at != '"'; ++at)
        at += *at == '\\' && at[1];
    return *at ? at + 1 : at;
}

// Any value: brackets are counted, so nesting costs no stack.
static const char* skip_value(const char* at)
{
    int open = 0;
    do {
        if (*at == '"')
            at = skip_string(at);
        else if (strchr("[]{}", *at)) {
            open += *at == '[' || *at == '{' ? 1 : -1;
            ++at;
        } else
            at += open ? 1 : (int)strcspn(at, " \t\r\n,]}");
    } while (*at && open > 0);
    return at;
}

// The beginning of member or element `number` of the value at `at`; of a member the key.
static const char* enter(const char* at, int number)
{
    bool object = *at == '{';
    at = skip_space(at + 1);
    for (; number > 0 && *at; --number) {
        if (object)
            at = skip_space(skip_string(at)) + 1; // the colon
        at = skip_space(skip_value(skip_space(at)));
        at = skip_space(at + (*at == ','));
    }
    return at;
}

ax_json_place ax_json_find(const char* text, const ax_json_path* path)
{
    const char* at = skip_space(text);
    for (int k = 0; k < path->depth; ++k) {
        bool object = *at == '{', wanted = path->key && k + 1 == path->depth;
        at = enter(at, path->steps[k]);
        if (object && !wanted)
            at = skip_space(skip_space(skip_string(at)) + 1);
    }
    ax_json_place place = {1, 1};
    for (const char* c = text; c < at; ++c) {
        if (*c == '\n')
            ++place.line, place.column = 1;
        else
            place.column += ((unsigned char)*c & 0xC0) != 0x80; // not inside a character of UTF-8
    }
    return place;
}
