#include "studio/hello.h"

#include "studio/describe.h"
#include "studio/draft.h"
#include "studio/files.h"
#include "studio/message.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char ending[] = ".json";

// Examples are recipes in the project's folder of that name.
const char* hello_first_example(void)
{
    return "welcome";
}

static char* path_of(const char* folder, const char* name, const char* ends)
{
    size_t size = strlen(folder) + strlen(name) + strlen(ends) + 2;
    char* path = ax_alloc(size, 1);
    snprintf(path, size, "%s/%s%s", folder, name, ends);
    if (files_name_is_plain(name) && access(path, R_OK) == 0)
        return path;
    ax_free(path);
    return NULL;
}

char* hello_example_path(const char* name)
{
    return path_of(ax_examples_folder(), name, ending);
}

char* hello_example_document(const char* name)
{
    return path_of(AX_EXAMPLE_DOCUMENTS_PATH, name, ".auxshell");
}

// What an example is about says its own note.
static json_t* example(const char* name, const char* title)
{
    char* path = hello_example_path(name);
    json_t* recipe = path ? json_load_file(path, 0, NULL) : NULL;
    const char* note = json_string_value(json_object_get(recipe, "note"));
    json_t* row = recipe ? json_pack("{s:s, s:s, s:s}", "name", name, "title", title, "doc", note ? note : "") : NULL;
    json_decref(recipe);
    ax_free(path);
    return row;
}

// The gallery's titles, in the order in which one wants to see them.
static json_t* example_list(void)
{
    char folder[PATH_MAX];
    snprintf(folder, sizeof folder, "%s/gallery", ax_examples_folder());
    char* path = path_of(folder, "titles", ending);
    json_t *titles = path ? json_load_file(path, 0, NULL) : NULL, *list = json_array(), *title;
    const char* name;
    json_object_foreach(titles, name, title)
    {
        json_t* row = example(name, json_string_value(title));
        if (row)
            json_array_append_new(list, row);
    }
    json_decref(titles);
    ax_free(path);
    return list;
}

json_t* hello_event(const char* folder, const char* start, int client)
{
    const char* slash = strrchr(folder, '/');
    return json_pack("{s:s, s:i, s:s, s:i, s:s, s:s, s:o, s:o, s:o, s:o, s:o, s:{s:i, s:i, s:i}}", "event", "hello",
                     "protocol", 1, "version", ax_version(), "client", client, "folder",
                     slash && slash[1] ? slash + 1 : folder, "start", start, "operators", describe_operators(),
                     "exporters", describe_exporters(), "making", describe_making(), "examples", example_list(),
                     "recovered", draft_list(), "limits", "message", MESSAGE_BYTES, "upload", UPLOAD_BYTES, "triangles",
                     2000000);
}
