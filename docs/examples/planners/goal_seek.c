/* The planner goal_seek as a program of its own: an example for docs/reference/planner_messages.md.
 *
 *     cc -O2 -o goal_seek goal_seek.c -lm
 *
 * Messages come in at descriptor 3 and go out at descriptor 4: four bytes with the length, lowest
 * first, then a msgpack map. Of these it reads numbers by their path, such as "limits.v_max".
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { IN = 3, OUT = 4 };
static const double PI = 3.14159265358979323846;

/* What a message says that this planner wants to know. */
struct heard {
    char type[16];
    double v_max, w_max, a_max;
    double pose[3], goal[2];
    uint64_t step;
};

/* ---------------------------------------------------------------- reading msgpack */
static const uint8_t *at, *end;

static void fail(const char *what) {
    fprintf(stderr, "goal_seek: %s\n", what);
    exit(1);
}

static uint64_t big_endian(int bytes) {
    uint64_t value = 0;
    if (end - at < bytes) fail("a message is cut");
    while (bytes--) value = value << 8 | *at++;
    return value;
}

static void walk(char *path, struct heard *h);

static void number(const char *path, double value, uint64_t whole, struct heard *h) {
    if (!strcmp(path, ".limits.v_max")) h->v_max = value;
    if (!strcmp(path, ".limits.w_max")) h->w_max = value;
    if (!strcmp(path, ".limits.a_max")) h->a_max = value;
    if (!strcmp(path, ".step")) h->step = whole;
    for (int k = 0; k < 3; k++) {
        char name[16];
        snprintf(name, sizeof name, ".pose.%d", k);
        if (!strcmp(path, name)) h->pose[k] = value;
        snprintf(name, sizeof name, ".goal.%d", k);
        if (k < 2 && !strcmp(path, name)) h->goal[k] = value;
    }
}

static void text(const char *path, uint64_t length, struct heard *h) {
    if ((uint64_t)(end - at) < length) fail("a message is cut");
    if (!strcmp(path, ".type") && length < sizeof h->type) {
        memcpy(h->type, at, length);
        h->type[length] = 0;
    }
    at += length;
}

/* Elements of a list are called by their number, those of a map by their key. */
static void many(char *path, uint64_t count, int is_map, struct heard *h) {
    size_t here = strlen(path);
    for (uint64_t k = 0; k < count; k++) {
        if (is_map) {
            uint8_t first = (uint8_t)big_endian(1);
            uint64_t length = first >= 0xa0 && first < 0xc0 ? first & 0x1fu
                              : first == 0xd9               ? big_endian(1)
                                                            : (fail("a key is not a text"), 0);
            if (here + length + 2 > 200 || (uint64_t)(end - at) < length) fail("a key is too long");
            path[here] = '.';
            memcpy(path + here + 1, at, length);
            path[here + 1 + length] = 0;
            at += length;
        } else {
            snprintf(path + here, 24, ".%llu", (unsigned long long)k);
        }
        walk(path, h);
        path[here] = 0;
    }
}

static void walk(char *path, struct heard *h) {
    uint8_t b = (uint8_t)big_endian(1);
    uint64_t bits;
    double d;
    float f;
    if (strlen(path) > 200) fail("a message is too deep");
    if (b < 0x80) number(path, b, b, h);
    else if (b < 0x90) many(path, b & 0x0f, 1, h);
    else if (b < 0xa0) many(path, b & 0x0f, 0, h);
    else if (b < 0xc0) text(path, b & 0x1f, h);
    else if (b >= 0xe0) number(path, (int8_t)b, 0, h);
    else switch (b) {
        case 0xc0: case 0xc2: case 0xc3: break;
        case 0xc4: case 0xd9: text(path, big_endian(1), h); break;
        case 0xc5: case 0xda: text(path, big_endian(2), h); break;
        case 0xc6: case 0xdb: text(path, big_endian(4), h); break;
        case 0xca: bits = big_endian(4); { uint32_t low = (uint32_t)bits; memcpy(&f, &low, 4); }
                   number(path, f, 0, h); break;
        case 0xcb: bits = big_endian(8); memcpy(&d, &bits, 8); number(path, d, 0, h); break;
        case 0xcc: bits = big_endian(1); number(path, (double)bits, bits, h); break;
        case 0xcd: bits = big_endian(2); number(path, (double)bits, bits, h); break;
        case 0xce: bits = big_endian(4); number(path, (double)bits, bits, h); break;
        case 0xcf: bits = big_endian(8); number(path, (double)bits, bits, h); break;
        case 0xd0: number(path, (int8_t)big_endian(1), 0, h); break;
        case 0xd1: number(path, (int16_t)big_endian(2), 0, h); break;
        case 0xd2: number(path, (int32_t)big_endian(4), 0, h); break;
        case 0xd3: number(path, (double)(int64_t)big_endian(8), 0, h); break;
        case 0xdc: many(path, big_endian(2), 0, h); break;
        case 0xdd: many(path, big_endian(4), 0, h); break;
        case 0xde: many(path, big_endian(2), 1, h); break;
        case 0xdf: many(path, big_endian(4), 1, h); break;
        default: fail("something that is not in a message");
    }
}

static int read_all(uint8_t *to, size_t count) {
    while (count) {
        ssize_t got = read(IN, to, count);
        if (got <= 0) return 0;
        to += got, count -= (size_t)got;
    }
    return 1;
}

/* The next message; 0 when there will be none. */
static int hear(struct heard *h) {
    static uint8_t *raw;
    uint8_t head[4];
    char path[256] = "";
    if (!read_all(head, 4)) return 0;
    size_t size = head[0] | head[1] << 8 | head[2] << 16 | (size_t)head[3] << 24;
    raw = realloc(raw, size + 1);
    if (!raw || !read_all(raw, size)) return 0;
    at = raw, end = raw + size, h->step = 0;
    walk(path, h);
    return 1;
}

/* ---------------------------------------------------------------- writing msgpack */
static uint8_t out[512];
static size_t length;

static void put_text(const char *s) {
    out[length++] = 0xd9, out[length++] = (uint8_t)strlen(s);
    memcpy(out + length, s, strlen(s)), length += strlen(s);
}

static void put_bits(uint8_t kind, uint64_t bits) {
    out[length++] = kind;
    for (int k = 7; k >= 0; k--) out[length++] = (uint8_t)(bits >> 8 * k);
}

static void put_double(double value) {
    uint64_t bits;
    memcpy(&bits, &value, 8), put_bits(0xcb, bits);
}

static void begin(const char *type, int fields, uint64_t step) {
    length = 4, out[length++] = (uint8_t)(0x80 | (fields + 2));
    put_text("type"), put_text(type), put_text("step"), put_bits(0xcf, step);
}

static void say(void) {
    size_t size = length - 4;
    for (int k = 0; k < 4; k++) out[k] = (uint8_t)(size >> 8 * k);
    for (size_t done = 0; done < length;) {
        ssize_t put = write(OUT, out + done, length - done);
        if (put <= 0) exit(1);
        done += (size_t)put;
    }
}

/* -------------------------------------------------------------------- the planner */
static double clip(double low, double value, double high) {
    return value < low ? low : value > high ? high : value;
}

static void plan(const struct heard *h, double *v, double *w) {
    double dx = h->goal[0] - h->pose[0], dy = h->goal[1] - h->pose[1];
    double distance = hypot(dx, dy);
    double error = remainder(atan2(dy, dx) - h->pose[2], 2.0 * PI);
    *v = *w = 0.0;
    if (distance <= 0.05) return;
    *w = clip(-h->w_max, 2.0 * error, h->w_max);
    if (fabs(error) > 0.785) return;
    *v = fmin(fmax(1.0 * h->v_max * cos(error), 0.0), sqrt(2.0 * h->a_max * distance));
}

int main(void) {
    struct heard h = {0};
    while (hear(&h) && strcmp(h.type, "close")) {
        if (!strcmp(h.type, "hello")) {
            begin("hello", 2, h.step);
            put_text("protocol"), out[length++] = 1;
            put_text("needs"), out[length++] = 0x90; /* an empty list: it reads no sensor */
        } else if (!strcmp(h.type, "reset")) {
            begin("ready", 0, h.step);
        } else {
            double v, w;
            plan(&h, &v, &w);
            begin("command", 2, h.step);
            put_text("v"), put_double(v), put_text("w"), put_double(w);
        }
        say();
    }
    return 0;
}
