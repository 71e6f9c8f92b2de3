#include "input/formula.h"

#include "input/number.h"

#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

// A formula becomes straight-line code for a stack of numbers, so that its value takes a bounded time and no memory.
enum { stack_size = 256, deepest = 128 };

typedef struct instruction {
    uint8_t arity; // 0: push `value` or a variable
    int variable;  // -1: none
    union {
        double value;
        double (*one)(double);
        double (*two)(double, double);
        double (*three)(double, double, double);
    };
} instruction;

struct ax_formula {
    int count;
    instruction code[];
};

static double add(double a, double b)
{
    return a + b;
}
static double subtract(double a, double b)
{
    return a - b;
}
static double multiply(double a, double b)
{
    return a * b;
}
static double divide(double a, double b)
{
    return a / b;
}
static double less(double a, double b)
{
    return a < b;
}
static double at_most(double a, double b)
{
    return a <= b;
}
static double greater(double a, double b)
{
    return a > b;
}
static double at_least(double a, double b)
{
    return a >= b;
}
static double equal(double a, double b)
{
    return a == b;
}
static double unequal(double a, double b)
{
    return a != b;
}
static double both(double a, double b)
{
    return a != 0 && b != 0;
}
static double either(double a, double b)
{
    return a != 0 || b != 0;
}
static double negate(double a)
{
    return -a;
}
static double not(double a)
{
    return a == 0;
}
static double choose(double condition, double a, double b)
{
    return condition != 0 ? a : b;
}
static double clamp(double v, double lo, double hi)
{
    return fmin(fmax(v, lo), hi);
}
static double sign(double a)
{
    return (a > 0) - (a < 0);
}
static double step(double edge, double v)
{
    return v >= edge;
}
static double smoothstep(double a, double b, double v)
{
    double t = fmin(fmax((v - a) / (b - a), 0), 1);
    return t * t * (3 - 2 * t);
}
static double modulo(double a, double b) // the sign of b, so that patterns go on through 0
{
    return a - b * floor(a / b);
}

typedef struct function {
    const char* name;
    int arity;
    bool more; // takes more arguments too, two by two
    double (*one)(double);
    double (*two)(double, double);
    double (*three)(double, double, double);
} function;

static const function functions[] = {
    {"abs", 1, .one = fabs},
    {"acos", 1, .one = acos},
    {"asin", 1, .one = asin},
    {"atan", 1, .one = atan},
    {"atan2", 2, .two = atan2},
    {"ceil", 1, .one = ceil},
    {"clamp", 3, .three = clamp},
    {"cos", 1, .one = cos},
    {"cosh", 1, .one = cosh},
    {"exp", 1, .one = exp},
    {"floor", 1, .one = floor},
    {"hypot", 2, .two = hypot},
    {"if", 3, .three = choose},
    {"log", 1, .one = log},
    {"log10", 1, .one = log10},
    {"max", 2, .more = true, .two = fmax},
    {"min", 2, .more = true, .two = fmin},
    {"mod", 2, .two = modulo},
    {"pow", 2, .two = pow},
    {"round", 1, .one = round},
    {"sign", 1, .one = sign},
    {"sin", 1, .one = sin},
    {"sinh", 1, .one = sinh},
    {"smoothstep", 3, .three = smoothstep},
    {"sqrt", 1, .one = sqrt},
    {"step", 2, .two = step},
    {"tan", 1, .one = tan},
    {"tanh", 1, .one = tanh},
};

typedef struct parser {
    const char *text, *at;
    int variable_count;
    const char* const* variables;
    int count, capacity, depth, stack; // stack: how many numbers lie on it here
    instruction* code;
    ax_status status;
    ax_error* error;
} parser;

// The first fault counts; after it every call returns without doing anything.
static void fail(parser* p, const char* place, const char* what)
{
    if (p->status != AX_OK)
        return;
    char there[40] = "ends";
    if (*place)
        snprintf(there, sizeof there, "reads \"%.24s%s\"", place, strlen(place) > 24 ? "..." : "");
    p->status = ax_fail(p->error, AX_BAD_INPUT, "The formula is wrong at column %d, where it %s: %s.",
                        (int)(place - p->text) + 1, there, what);
}

static void emit(parser* p, instruction code)
{
    if (p->status != AX_OK)
        return;
    p->stack += 1 - code.arity;
    if (p->stack > stack_size) {
        fail(p, p->at, "it is nested too deeply");
        return;
    }
    if (p->count == p->capacity) {
        p->capacity = p->capacity ? 2 * p->capacity : 32;
        p->code = ax_realloc(p->code, (size_t)p->capacity, sizeof *p->code);
    }
    p->code[p->count++] = code;
}

static void emit_two(parser* p, double (*two)(double, double))
{
    emit(p, (instruction){.arity = 2, .two = two});
}

static void skip_space(parser* p)
{
    while (isspace((unsigned char)*p->at))
        ++p->at;
}

static bool take(parser* p, const char* word)
{
    skip_space(p);
    size_t length = strlen(word);
    if (p->status != AX_OK || strncmp(p->at, word, length) != 0)
        return false;
    p->at += length;
    return true;
}

static void expect(parser* p, const char* word, const char* what)
{
    if (!take(p, word))
        fail(p, p->at, what);
}

static void parse_choice(parser* p);

static void parse_call(parser* p, const function* f, const char* name)
{
    expect(p, "(", "a function needs its arguments in parentheses");
    int count = 0;
    do {
        parse_choice(p);
        ++count;
        if (f->more && count >= 2)
            emit_two(p, f->two);
    } while (take(p, ","));
    if (count < f->arity || (count > f->arity && !f->more)) {
        char what[80];
        snprintf(what, sizeof what, "%s takes %d argument%s%s, not %d", f->name, f->arity, f->arity == 1 ? "" : "s",
                 f->more ? " or more" : "", count);
        fail(p, name, what);
    }
    expect(p, ")", "a parenthesis is not closed; a ) or a comma should stand");
    if (!f->more) {
        instruction code = {.arity = (uint8_t)f->arity};
        if (f->arity == 1)
            code.one = f->one;
        else if (f->arity == 2)
            code.two = f->two;
        else
            code.three = f->three;
        emit(p, code);
    }
}

static bool named(const char* name, size_t length, const char* word)
{
    return strlen(word) == length && strncmp(name, word, length) == 0;
}

static void parse_name(parser* p)
{
    const char* name = p->at;
    while (isalnum((unsigned char)*p->at) || *p->at == '_')
        ++p->at;
    size_t length = (size_t)(p->at - name);
    for (int k = 0; k < p->variable_count; ++k)
        if (named(name, length, p->variables[k])) {
            emit(p, (instruction){.variable = k});
            return;
        }
    if (named(name, length, "pi")) {
        emit(p, (instruction){.variable = -1, .value = M_PI});
        return;
    }
    for (size_t k = 0; k < sizeof functions / sizeof *functions; ++k)
        if (named(name, length, functions[k].name)) {
            parse_call(p, &functions[k], name);
            return;
        }
    enum { FUNCTIONS = sizeof functions / sizeof *functions };
    const char** known = ax_alloc((size_t)p->variable_count + FUNCTIONS + 1, sizeof *known);
    int count = 0;
    for (int k = 0; k < p->variable_count; ++k)
        known[count++] = p->variables[k];
    known[count++] = "pi";
    for (int k = 0; k < FUNCTIONS; ++k)
        known[count++] = functions[k].name;
    char what[400], word[32];
    snprintf(word, sizeof word, "%.*s", (int)length, name);
    const char* nearest = length < sizeof word && length > 1 ? ax_nearest_word(word, count, known) : NULL;
    snprintf(what, sizeof what, "there is no such name%s%s; the variables are", nearest ? ", did you mean " : "",
             nearest ? nearest : "");
    for (int k = 0; k < p->variable_count; ++k) {
        size_t used = strlen(what);
        snprintf(what + used, sizeof what - used, "%s %s", k ? "," : "", p->variables[k]);
    }
    ax_free(known);
    fail(p, name, what);
}

static void parse_primary(parser* p)
{
    skip_space(p);
    instruction number = {.variable = -1};
    const char* after = isdigit((unsigned char)*p->at) || *p->at == '.' ? ax_number_read(p->at, &number.value) : NULL;
    if (after) {
        p->at = after;
        emit(p, number);
    } else if (take(p, "(")) {
        parse_choice(p);
        expect(p, ")", "a parenthesis is not closed; a ) should stand");
    } else if (isalpha((unsigned char)*p->at) || *p->at == '_')
        parse_name(p);
    else
        fail(p, p->at, "a number, a name or a parenthesis should stand");
}

// Everything that nests passes here, so its depth bounds the recursion.
static void parse_sign(parser* p)
{
    if (++p->depth > deepest)
        fail(p, p->at, "it is nested too deeply");
    skip_space(p);
    if (p->status != AX_OK)
        ;
    else if (take(p, "-")) {
        parse_sign(p);
        emit(p, (instruction){.arity = 1, .one = negate});
    } else if (take(p, "+"))
        parse_sign(p);
    else if (p->at[0] == '!' && p->at[1] != '=') {
        ++p->at;
        parse_sign(p);
        emit(p, (instruction){.arity = 1, .one = not });
    } else {
        parse_primary(p);
        if (take(p, "^")) {
            parse_sign(p);
            emit_two(p, pow);
        }
    }
    --p->depth;
}

static void parse_product(parser* p)
{
    parse_sign(p);
    for (;;) {
        double (*two)(double, double) = take(p, "*") ? multiply : (take(p, "/") ? divide : NULL);
        if (!two)
            return;
        parse_sign(p);
        emit_two(p, two);
    }
}

static void parse_sum(parser* p)
{
    parse_product(p);
    for (;;) {
        double (*two)(double, double) = take(p, "+") ? add : (take(p, "-") ? subtract : NULL);
        if (!two)
            return;
        parse_product(p);
        emit_two(p, two);
    }
}

static double (*take_comparison(parser* p))(double, double)
{
    static const struct {
        const char* word;
        double (*two)(double, double);
    } comparisons[] = {{"<=", at_most}, {">=", at_least}, {"==", equal}, {"!=", unequal}, {"<", less}, {">", greater}};
    for (size_t k = 0; k < sizeof comparisons / sizeof *comparisons; ++k)
        if (take(p, comparisons[k].word))
            return comparisons[k].two;
    return NULL;
}

static void parse_comparison(parser* p)
{
    parse_sum(p);
    double (*two)(double, double) = take_comparison(p);
    if (!two)
        return;
    parse_sum(p);
    emit_two(p, two);
    const char* place = p->at;
    if (take_comparison(p))
        fail(p, place, "comparisons do not chain; write a < b && b < c");
}

static void parse_and(parser* p)
{
    parse_comparison(p);
    while (take(p, "&&")) {
        parse_comparison(p);
        emit_two(p, both);
    }
}

static void parse_or(parser* p)
{
    parse_and(p);
    while (take(p, "||")) {
        parse_and(p);
        emit_two(p, either);
    }
}

static void parse_choice(parser* p)
{
    if (++p->depth > deepest)
        fail(p, p->at, "it is nested too deeply");
    if (p->status == AX_OK)
        parse_or(p);
    if (take(p, "?")) {
        parse_choice(p);
        expect(p, ":", "a colon should stand, as in condition ? a : b");
        parse_choice(p);
        emit(p, (instruction){.arity = 3, .three = choose});
    }
    --p->depth;
}

ax_status ax_formula_parse(const char* text, int variable_count, const char* const* variables, ax_formula** out,
                           ax_error* error)
{
    *out = NULL;
    if (strlen(text) > AX_FORMULA_LENGTH)
        return ax_fail(error, AX_BAD_INPUT,
                       "The formula has %zu characters; it may have %d. Write the field to a CSV table instead.",
                       strlen(text), AX_FORMULA_LENGTH);
    parser p = {text, text, variable_count, variables, .error = error};
    parse_choice(&p);
    skip_space(&p);
    if (*p.at)
        fail(&p, p.at, "the formula should end or go on with an operator");
    if (p.status == AX_OK) {
        *out = ax_alloc(1, sizeof **out + (size_t)p.count * sizeof *p.code);
        (*out)->count = p.count;
        memcpy((*out)->code, p.code, (size_t)p.count * sizeof *p.code);
    }
    ax_free(p.code);
    return p.status;
}

void ax_formula_free(ax_formula* formula)
{
    ax_free(formula);
}

double ax_formula_value(const ax_formula* formula, const double* variables)
{
    double below[stack_size], *rest = below, top = 0; // the rest of the stack, and the number on top
    for (const instruction *i = formula->code, *end = i + formula->count; i < end; ++i)
        switch (i->arity) {
        case 0:
            *rest++ = top;
            top = i->variable < 0 ? i->value : variables[i->variable];
            break;
        case 1:
            top = i->one(top);
            break;
        case 2:
            top = i->two(*--rest, top);
            break;
        default:
            rest -= 2;
            top = i->three(rest[0], rest[1], top);
        }
    return top;
}
