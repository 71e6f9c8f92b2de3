// Tables for people and JSON of what the library found.
#pragma once

#include "ax/form.h"
#include "ax/report.h"
#include "ax/target.h"

#include <jansson.h>
#include <stdio.h>

// "Mean edge L   0.4312 m" for every figure, grouped, with limits and whether they hold, and a last line that sums up.
void report_print(const ax_design* design, FILE* out);
// The figures whose limits are not kept, of the states that there are; nothing if there are none. How many.
int report_print_failing(const ax_design* design, FILE* out);
// All figures by key; what is missing is null.
json_t* report_json(const ax_design* design);

// What holds a form and by how much it is missed, and its findings, a line each.
void form_print(const ax_form_report* report, ax_unit unit, FILE* out);
// {"held": [...], "findings": [...]}
json_t* form_json(const ax_form_report* report);

// What was mended while reading, as one sentence: "12 vertices welded, 3 faces turned".
void repairs_print(const ax_mesh_repairs* repairs, FILE* out);
json_t* repairs_json(const ax_mesh_repairs* repairs);

// "inflation at 100 Pa", "gravity on 4 kg/m2 towards +z"
void load_words(const ax_load* load, char* words, size_t size);

// Consumes and prints a JSON value, indented.
void json_print(json_t* value, FILE* out);
// A number, null if it is not finite.
json_t* json_number(double x);
json_t* json_numbers(const double* x, int count);
