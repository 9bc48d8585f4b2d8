#define BASE_FACTOR 6u
