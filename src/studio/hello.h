// What the studio tells a page first: itself, the operators and exporters there are, and what can be opened.
#pragma once

#include <jansson.h>

json_t* hello_event(const char* folder, const char* start, int client);
// The example that a studio without a document starts on, and where examples lie: NULL if there is none of this name.
const char* hello_first_example(void);
char* hello_example_path(const char* name);
// The document that the build made of an example; NULL if there is none.
char* hello_example_document(const char* name);
