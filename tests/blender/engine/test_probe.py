import bpy, numpy as np, OpenEXR
def test_probe(scene, add_camera, add_surfels, picture, passes, capfd):
    add_camera()
    add_surfels([(0,0,0),(1,1,0)], size=.5)
    bpy.ops.mesh.primitive_cube_add()
    p = picture()
    out = capfd.readouterr()
    print("OUT", repr(out.out[-600:]), "ERR", repr(out.err[-300:]))
    print(p.shape, p[...,3].sum())
    scene.view_layers[0].use_pass_z = True
    d = passes()
    print({k:(v.shape,v.dtype) for k,v in d.items()})
    scene.camera=None
    try: picture()
    except RuntimeError as e: print("ERRR", e)
