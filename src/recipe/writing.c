#include "recipe/writing.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void add(ax_text* text, const char* bytes, size_t size)
{
    if (text->size + size + 1 > text->capacity) {
        text->capacity = 2 * (text->size + size + 1);
        text->bytes = ax_realloc(text->bytes, text->capacity, 1);
    }
    memcpy(text->bytes + text->size, bytes, size);
    text->bytes[text->size += size] = 0;
}

void ax_text_say(ax_text* text, const char* words)
{
    add(text, words, strlen(words));
}

static void add_real(ax_text* text, double value)
{
    char digits[40];
    for (int precision = 15; precision <= 17; ++precision) {
        snprintf(digits, sizeof digits, "%.*g", precision, value);
        if (strtod(digits, NULL) == value)
            break;
    }
    ax_text_say(text, digits);
    if (!strpbrk(digits, ".en"))
        ax_text_say(text, ".0"); // stays a real number
}

static void add_value(ax_text* text, const json_t* value)
{
    const char* key;
    json_t* member;
    bool first = true;
    if (json_is_object(value)) {
        ax_text_say(text, "{");
        json_object_foreach((json_t*)value, key, member)
        {
            json_t* name = json_string(key);
            ax_text_say(text, first ? "" : ", ");
            add_value(text, name);
            ax_text_say(text, ": ");
            add_value(text, member);
            json_decref(name);
            first = false;
        }
        ax_text_say(text, "}");
    } else if (json_is_array(value)) {
        ax_text_say(text, "[");
        for (size_t k = 0; k < json_array_size(value); ++k) {
            ax_text_say(text, k ? ", " : "");
            add_value(text, json_array_get(value, k));
        }
        ax_text_say(text, "]");
    } else if (json_is_real(value))
        add_real(text, json_real_value(value));
    else {
        char* plain = json_dumps(value, JSON_ENCODE_ANY);
        ax_text_say(text, plain ? plain : "null");
        free(plain);
    }
}

void ax_text_add_json(ax_text* text, const json_t* value)
{
    locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0), before = uselocale(plain);
    add_value(text, value);
    uselocale(before);
    freelocale(plain);
}
