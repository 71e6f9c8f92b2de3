#include "studio/message.h"

#include <stdarg.h>
#include <string.h>

// Nesting of brackets outside of strings: jansson's own limit would let 2,048 levels through.
static bool too_deep(const char* bytes, size_t size)
{
    int depth = 0;
    bool text = false;
    for (size_t k = 0; k < size; ++k) {
        char c = bytes[k];
        if (text)
            k += c == '\\', text = c != '"';
        else if (c == '"')
            text = true;
        else if ((c == '{' || c == '[') && ++depth > MESSAGE_DEPTH)
            return true;
        else if (c == '}' || c == ']')
            --depth;
    }
    return false;
}

ax_status message_read(const char* bytes, size_t size, message* out, ax_error* error)
{
    *out = (message){0};
    if (too_deep(bytes, size))
        return ax_fail(error, AX_USAGE, "The message is nested deeper than %d levels.", MESSAGE_DEPTH);
    json_error_t fault;
    json_t* root = json_loadb(bytes, size, JSON_REJECT_DUPLICATES, &fault);
    if (!root)
        return ax_fail(error, AX_USAGE, "The message is no JSON object: %s, line %d, column %d.", fault.text,
                       fault.line, fault.column);
    if (!json_is_object(root)) {
        json_decref(root);
        return ax_fail(error, AX_USAGE,
                       "The message is no JSON object: commands look like {\"do\": \"undo\", \"id\": 1}.");
    }
    out->parameters = root;
    json_t* id = json_object_get(root, "id");
    if (id) {
        json_int_t value = json_is_integer(id) ? json_integer_value(id) : 0;
        if (value < 1 || value > 0x7fffffff)
            return ax_fail(error, AX_USAGE, "\"id\" is a whole number from 1 to 2147483647.");
        out->id = (int)value;
        json_object_del(root, "id");
    }
    const char* action = json_string_value(json_object_get(root, "do"));
    if (!action || !*action || strlen(action) >= sizeof out->action)
        return ax_fail(error, AX_USAGE, "The message names no command in \"do\".");
    strcpy(out->action, action);
    json_object_del(root, "do");
    return AX_OK;
}

void message_free(message* m)
{
    json_decref(m->parameters);
    *m = (message){0};
}

ax_status message_unpack(const message* m, ax_error* error, const char* format, ...)
{
    json_error_t fault;
    va_list arguments;
    va_start(arguments, format);
    int failed = json_vunpack_ex(m->parameters, &fault, JSON_STRICT, format, arguments);
    va_end(arguments);
    return failed ? ax_fail(error, AX_USAGE, "%s: %s.", m->action, fault.text) : AX_OK;
}
