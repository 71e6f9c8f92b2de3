// The gallery as a page of Markdown, with pictures beside it.
#pragma once

#include "ax/form.h"
#include "ax/recipe.h"

#include <jansson.h>

typedef struct gallery_page gallery_page;

// `path` is the page to write; pictures go to pictures/gallery in its folder, which is made if only its last part is missing.
ax_status gallery_page_open(const char* path, gallery_page** out, ax_error* error);
// Adds an example: its title, its author's note, pictures of its states, figures.
ax_status gallery_page_add(gallery_page* page, const char* name, const ax_recipe* recipe, const json_t* example,
                           const ax_design* design, const ax_form_report* form, double seconds, ax_error* error);
ax_status gallery_page_write(gallery_page* page, ax_error* error);
void gallery_page_close(gallery_page* page); // NULL allowed
