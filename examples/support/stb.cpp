// SPDX-License-Identifier: MIT
//
// The one place where stb's code is compiled; its own warnings are not ours. It reads the formats that its authors test most: its readers of
// the others (GIF, HDR, PIC, PNM, PSD) go beyond their memory over files that are broken on purpose (CVE-2021-42716, CVE-2023-45661).
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_TRUETYPE_IMPLEMENTATION
#define STBI_FAILURE_USERMSG
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#include <stb/stb_truetype.h>
