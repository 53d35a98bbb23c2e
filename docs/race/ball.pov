// The ball of the race for POV-Ray 3.7: a glass sphere over a grey floor under a lamp of radius 0.08 m.
//   povray +Iball.pov +Oball.hdr +W512 +H512 -D -A +WT2 +FH
// Units of light are POV-Ray's; 1.66 times the picture is radiance as in the glTF file, by the median over the floor.
#version 3.7;
global_settings {
  assumed_gamma 1
  max_trace_level 20
  photons { spacing 0.0013 gather 30, 80 max_trace_level 20 autostop 0 }
}
// Vectors as long as the picture is wide at distance 1: a field of view of 40 degrees, and x to the right.
#declare Width = 2 * tan(radians(20));
#declare Eye = <3.0, 3.4, 3.6>;
#declare Forward = vnormalize(<0.3, 0.75, 0.2> - Eye);
#declare Right = vnormalize(vcross(Forward, y));
camera {
  perspective
  location Eye
  direction Forward
  right Width * Right
  up Width * vcross(Right, Forward)
}
// A square of the disc's area.
light_source {
  <-2, 5, -1>, rgb 20
  area_light <0.142, 0, 0>, <0, 0, 0.142>, 16, 16 adaptive 1 jitter circular orient
  fade_distance 1
  fade_power 2
  photons { refraction on reflection on area_light }
}
polygon {
  5, <-6, 0, -6>, <6, 0, -6>, <6, 0, 6>, <-6, 0, 6>, <-6, 0, -6>
  pigment { rgb 0.6 }
  finish { diffuse 1 ambient 0 }
}
sphere {
  <0, 1.2, 0>, 1
  pigment { rgbt 1 }
  finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }
  interior { ior 1.5 }
  photons { target refraction on reflection on collect off }
}
