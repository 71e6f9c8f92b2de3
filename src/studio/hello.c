#include "studio/hello.h"

#include "studio/describe.h"
#include "studio/draft.h"
#include "studio/files.h"
#include "studio/message.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

// Recipes and documents among the project's examples, which the installed program finds beside itself.
static const struct {
    const char *name, *file, *title, *doc;
} examples[] = {
    {"welcome", "welcome.json", "Pavilion",
     "A shell over an oval, higher at one end, on an elliptical rim, inflated."},
    {"figure-4", "figure-4.json", "Figure 4", "Painted, hung, expanded, smoothed, and given a circle to stand on."},
};
enum { EXAMPLES = sizeof examples / sizeof *examples };

const char* hello_first_example(void)
{
    return examples[0].name;
}

char* hello_example_path(const char* name)
{
    for (int k = 0; k < EXAMPLES; ++k)
        if (strcmp(examples[k].name, name) == 0) {
            size_t size = strlen(AX_EXAMPLES_PATH) + strlen(examples[k].file) + 2;
            char* path = ax_alloc(size, 1);
            snprintf(path, size, "%s/%s", AX_EXAMPLES_PATH, examples[k].file);
            return path;
        }
    return NULL;
}

static json_t* example_list(void)
{
    json_t* list = json_array();
    for (int k = 0; k < EXAMPLES; ++k) {
        char* path = hello_example_path(examples[k].name);
        if (access(path, R_OK) == 0)
            json_array_append_new(list, json_pack("{s:s, s:s, s:s}", "name", examples[k].name, "title",
                                                  examples[k].title, "doc", examples[k].doc));
        ax_free(path);
    }
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
