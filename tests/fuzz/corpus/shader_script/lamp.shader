// c
textures/x/lamp
{
  surfaceparm nomarks
  q3map_surfacelight 200
  q3map_lightRGB 1 .5 0
  /* b */ { map $lightmap }
  { animMap 10 a.tga b.tga
    blendFunc GL_ONE GL_ONE
    tcGen environment
    tcMod scroll 1 1 }
}
