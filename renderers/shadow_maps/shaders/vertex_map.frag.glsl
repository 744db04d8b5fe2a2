// Pass: pieces of triangles into hemispherical maps. Out: their depth alone.

void main() {}
