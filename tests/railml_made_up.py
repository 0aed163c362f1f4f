"""Small infrastructures in railML 3 and railML 2, made up: a line over two tracks, and a branch."""

RAILML_3 = """\
<?xml version="1.0" encoding="UTF-8"?>
<railML xmlns="https://www.railml.org/schemas/3.2" version="3.2">
  <common id="co">
    <electrificationSystems>
      <electrificationSystem id="es" voltage="25000" frequency="50"/>
    </electrificationSystems>
    <positioning>
      <linearPositioningSystems>
        <linearPositioningSystem id="lps" units="m" startMeasure="10000" endMeasure="20000"/>
      </linearPositioningSystems>
    </positioning>
    <speedProfiles>
      <speedProfile id="all" isBasicSpeedProfile="true"/>
      <speedProfile id="freight"/>
    </speedProfiles>
  </common>
  <infrastructure id="i">
    <topology>
      <netElements>
        <netElement id="ne_a" length="6000">
          <associatedPositioningSystem id="a_aps">
            <intrinsicCoordinate id="a0" intrinsicCoord="0">
              <linearCoordinate positioningSystemRef="lps" measure="10000"/>
            </intrinsicCoordinate>
            <intrinsicCoordinate id="a1" intrinsicCoord="1">
              <linearCoordinate positioningSystemRef="lps" measure="16000"/>
            </intrinsicCoordinate>
          </associatedPositioningSystem>
        </netElement>
        <netElement id="ne_b">
          <associatedPositioningSystem id="b_aps">
            <intrinsicCoordinate id="b0" intrinsicCoord="0">
              <linearCoordinate positioningSystemRef="lps" measure="20000"/>
            </intrinsicCoordinate>
            <intrinsicCoordinate id="b1" intrinsicCoord="1">
              <linearCoordinate positioningSystemRef="lps" measure="16000"/>
            </intrinsicCoordinate>
          </associatedPositioningSystem>
        </netElement>
        <netElement id="ne_c"/>
        <netElement id="ne_m">
          <elementCollectionOrdered id="m_eco">
            <elementPart ref="ne_a"/><elementPart ref="ne_b"/>
          </elementCollectionOrdered>
        </netElement>
      </netElements>
      <netRelations>
        <netRelation id="nr_ac" positionOnA="1" positionOnB="0" navigability="Both">
          <elementA ref="ne_a"/><elementB ref="ne_c"/>
        </netRelation>
        <netRelation id="nr_ab" positionOnA="1" positionOnB="1" navigability="Both">
          <elementA ref="ne_a"/><elementB ref="ne_b"/>
        </netRelation>
        <netRelation id="nr_bc" positionOnA="1" positionOnB="0" navigability="None">
          <elementA ref="ne_b"/><elementB ref="ne_c"/>
        </netRelation>
      </netRelations>
      <networks>
        <network id="nw">
          <level id="lv0" descriptionLevel="Micro">
            <networkResource ref="ne_a"/><networkResource ref="ne_b"/><networkResource ref="ne_c"/>
            <networkResource ref="nr_ab"/><networkResource ref="nr_ac"/><networkResource ref="nr_bc"/>
          </level>
          <level id="lv1" descriptionLevel="Meso"><networkResource ref="ne_m"/></level>
        </network>
      </networks>
    </topology>
    <functionalInfrastructure>
      <balises><balise id="bal"/></balises>
      <electrificationSections>
        <electrificationSection id="el">
          <linearLocation id="el_l">
            <associatedNetElement netElementRef="ne_a" keepsOrientation="true"/>
          </linearLocation>
          <electrificationSystemRef ref="es"/>
          <phaseSeparationSection/>
        </electrificationSection>
      </electrificationSections>
      <gradientCurves>
        <gradientCurve id="g1" curveType="straight" gradient="5">
          <linearLocation id="g1_l">
            <associatedNetElement netElementRef="ne_a" keepsOrientation="true"
              posBegin="1000" posEnd="3000"/>
          </linearLocation>
        </gradientCurve>
        <gradientCurve id="g2" curveType="arc" deltaGradient="-8">
          <linearLocation id="g2_l">
            <associatedNetElement netElementRef="ne_a" keepsOrientation="true"
              posBegin="3000" posEnd="3400"/>
          </linearLocation>
        </gradientCurve>
        <gradientCurve id="g3" curveType="straight" gradient="-3">
          <linearLocation id="g3_l">
            <associatedNetElement netElementRef="ne_a" keepsOrientation="true"
              posBegin="3400" posEnd="6000"/>
          </linearLocation>
        </gradientCurve>
        <gradientCurve id="g4" curveType="straight" gradient="2">
          <linearLocation id="g4_l">
            <associatedNetElement netElementRef="ne_b" keepsOrientation="true"
              posBegin="3000" posEnd="4000"/>
          </linearLocation>
        </gradientCurve>
      </gradientCurves>
      <horizontalCurves>
        <horizontalCurve id="h1" curveType="arc" radius="-800">
          <linearLocation id="h1_l">
            <associatedNetElement netElementRef="ne_a" keepsOrientation="true"
              intrinsicCoordBegin="0.5" intrinsicCoordEnd="0.6"/>
          </linearLocation>
        </horizontalCurve>
      </horizontalCurves>
      <lines>
        <line id="l1">
          <name name="Hauptbahn" language="de"/><name name="Main" language="en"/>
          <linearLocation id="l1_l">
            <associatedNetElement netElementRef="ne_m" keepsOrientation="true"/>
          </linearLocation>
        </line>
        <line id="l2">
          <name name="Branch" language="en"/>
          <linearLocation id="l2_l">
            <associatedNetElement netElementRef="ne_c" keepsOrientation="true"/>
          </linearLocation>
          <linePerformance maxSpeed="60"/>
        </line>
      </lines>
      <operationalPoints>
        <operationalPoint id="op1">
          <name name="West" language="en"/>
          <spotLocation id="op1_s" netElementRef="ne_a" intrinsicCoord="0.0"/>
        </operationalPoint>
        <operationalPoint id="op2">
          <name name="Middle" language="en"/>
          <spotLocation id="op2_s" netElementRef="ne_m">
            <linearCoordinate positioningSystemRef="lps" measure="13000"/>
          </spotLocation>
        </operationalPoint>
        <operationalPoint id="op3">
          <name name="East" language="en"/>
          <linearLocation id="op3_l">
            <associatedNetElement netElementRef="ne_b" keepsOrientation="true"
              posBegin="0" posEnd="200"/>
          </linearLocation>
        </operationalPoint>
        <operationalPoint id="op4">
          <designator register="_made_up" entry="Mine"/>
          <opEquipment><ownsPlatform ref="pf"/></opEquipment>
        </operationalPoint>
        <operationalPoint id="op5"><name name="Lost" language="en"/></operationalPoint>
      </operationalPoints>
      <platforms>
        <platform id="pf">
          <linearLocation id="pf_l">
            <associatedNetElement netElementRef="ne_c" keepsOrientation="true"
              posBegin="4800" posEnd="5000"/>
          </linearLocation>
        </platform>
      </platforms>
      <signalsIS><signalIS id="s1"/><signalIS id="s2"/></signalsIS>
      <speeds>
        <speedSection id="s120" maxSpeed="120">
          <linearLocation id="s120_l" applicationDirection="both">
            <associatedNetElement netElementRef="ne_a" keepsOrientation="true"/>
            <associatedNetElement netElementRef="ne_b" keepsOrientation="false"/>
          </linearLocation>
          <validForSpeedProfile ref="all"/>
        </speedSection>
        <speedSection id="s80" maxSpeed="80">
          <linearLocation id="s80_l" applicationDirection="normal">
            <associatedNetElement netElementRef="ne_a" keepsOrientation="true">
              <linearCoordinateBegin positioningSystemRef="lps" measure="15000"/>
              <linearCoordinateEnd positioningSystemRef="lps" measure="16000"/>
            </associatedNetElement>
            <associatedNetElement netElementRef="ne_b" keepsOrientation="false"
              fromPos="3000" toPos="4000"/>
          </linearLocation>
        </speedSection>
        <speedSection id="s20" maxSpeed="20" isTemporary="true">
          <linearLocation id="s20_l">
            <associatedNetElement netElementRef="ne_a" keepsOrientation="true"/>
          </linearLocation>
        </speedSection>
        <speedSection id="s70" maxSpeed="70">
          <linearLocation id="s70_l">
            <associatedNetElement netElementRef="ne_a" keepsOrientation="true"/>
          </linearLocation>
          <validForSpeedProfile ref="freight"/>
        </speedSection>
      </speeds>
      <switchesIS>
        <switchIS id="sw" continueCourse="right">
          <name name="Fork" language="en"/>
          <leftBranch netRelationRef="nr_ac"/><rightBranch netRelationRef="nr_ab"/>
        </switchIS>
      </switchesIS>
      <tracks>
        <track id="t_c" type="mainTrack">
          <linearLocation id="t_c_l">
            <associatedNetElement netElementRef="ne_c" keepsOrientation="true"/>
          </linearLocation>
          <length type="physical" value="5000"/>
        </track>
      </tracks>
    </functionalInfrastructure>
  </infrastructure>
</railML>
"""
"""ne_a from km 10 to the switch at km 16, ne_b from km 20 back to it, the branch ne_c, and ne_m for both
of the main line."""

RAILML_2 = """\
<?xml version="1.0" encoding="UTF-8"?>
<railml xmlns="https://www.railml.org/schemas/2018" version="2.4">
  <infrastructure id="i">
    <tracks>
      <track id="t1" name="1" type="mainTrack">
        <trackTopology>
          <trackBegin id="t1b" pos="0" absPos="10000"><bufferStop id="bs"/></trackBegin>
          <trackEnd id="t1e" pos="6000"><connection id="c1" ref="c3"/></trackEnd>
          <mileageChanges>
            <mileageChange id="m" pos="2000" absPosIn="12000" absPos="12500" type="missing"/>
          </mileageChanges>
          <connections>
            <switch id="sw" name="Fork" pos="4000">
              <connection id="c4" ref="c2" orientation="outgoing" course="left"/>
            </switch>
          </connections>
          <crossSections>
            <crossSection id="x1" ocpRef="ocp_w" pos="0"/>
            <crossSection id="x2" ocpRef="ocp_m" pos="1000"/>
          </crossSections>
        </trackTopology>
        <trackElements>
          <speedChanges>
            <speedChange id="v1" pos="0" dir="up" vMax="100" profileRef="p_all"/>
            <speedChange id="v2" pos="3000" dir="up" vMax="80" profileRef="p_all"/>
            <speedChange id="v3" pos="0" dir="up" vMax="50" profileRef="p_freight"/>
          </speedChanges>
          <gradientChanges>
            <gradientChange id="g1" pos="0" slope="5"/><gradientChange id="g2" pos="3000" slope="-2"/>
          </gradientChanges>
          <electrificationChanges>
            <electrificationChange id="e1" pos="0" type="overhead" voltage="15000" frequency="16.7"/>
          </electrificationChanges>
          <radiusChanges>
            <radiusChange id="r1" pos="500" radius="700"/><radiusChange id="r2" pos="900" radius="0"/>
          </radiusChanges>
          <platformEdges><platformEdge id="pe" pos="900" length="200"/></platformEdges>
        </trackElements>
        <ocsElements>
          <signals><signal id="s1" pos="100"/><signal id="s2" pos="200"/></signals>
        </ocsElements>
      </track>
      <track id="t2" name="2" type="secondaryTrack">
        <trackTopology>
          <trackBegin id="t2b" pos="0"><connection id="c2" ref="c4"/></trackBegin>
          <trackEnd id="t2e" pos="3000"><macroscopicNode ocpRef="ocp_i"/></trackEnd>
        </trackTopology>
      </track>
      <track id="t3" name="1" type="mainTrack">
        <trackTopology>
          <trackBegin id="t3b" pos="0" absPos="20500"><openEnd id="oe"/></trackBegin>
          <trackEnd id="t3e" pos="4000" absPos="16500"><connection id="c3" ref="c1"/></trackEnd>
          <crossSections><crossSection id="x3" ocpRef="ocp_e" pos="100"/></crossSections>
        </trackTopology>
        <trackElements>
          <speedChanges>
            <speedChange id="v4" pos="2000" dir="down" vMax="120" profileRef="p_all"/>
            <speedChange id="v5" pos="0" dir="up" vMax="90" profileRef="p_all"/>
          </speedChanges>
          <gradientChanges><gradientChange id="g3" pos="0" slope="1"/></gradientChanges>
        </trackElements>
      </track>
    </tracks>
    <trackGroups>
      <line id="l1" name="Main"><trackRef ref="t1"/><trackRef ref="t3"/></line>
      <line id="l2" name="Branch"><trackRef ref="t2"/></line>
    </trackGroups>
    <speedProfiles><speedProfile id="p_all"/><speedProfile id="p_freight"/></speedProfiles>
    <operationControlPoints>
      <ocp id="ocp_w" name="West"/><ocp id="ocp_m" name="Middle"/><ocp id="ocp_e" name="East"/>
      <ocp id="ocp_i" name="Mine"/><ocp id="ocp_l" name="Lost"/>
    </operationControlPoints>
  </infrastructure>
</railml>
"""
"""t1 from km 10 to km 16.5, where 0.5 km of kilometres are missing, with a switch to t2 at 4 km; t3 runs
from km 20.5 back to the end of t1."""

TRAINS_2 = """\
  <timetable id="tt">
    <trainParts>
      <trainPart id="p1">
        <ocpsTT>
          <ocpTT ocpRef="ocp_w" sequence="1"><times scope="scheduled" departure="06:00:00"/></ocpTT>
          <ocpTT ocpRef="ocp_m" sequence="2" ocpType="pass">
            <times scope="scheduled" departure="06:01:30"/>
          </ocpTT>
          <ocpTT ocpRef="ocp_i" sequence="3"><times scope="scheduled" arrival="06:10:00"/></ocpTT>
        </ocpsTT>
      </trainPart>
      <trainPart id="p2">
        <ocpsTT>
          <ocpTT ocpRef="ocp_w" sequence="1"><times scope="scheduled" departure="07:00:00"/></ocpTT>
          <ocpTT ocpRef="ocp_l" sequence="2"><times scope="scheduled" arrival="07:10:00"/></ocpTT>
        </ocpsTT>
      </trainPart>
    </trainParts>
    <trains>
      <train id="tr1" type="operational" trainNumber="4101">
        <trainPartSequence sequence="1"><trainPartRef ref="p1"/></trainPartSequence>
      </train>
      <train id="tr2" type="operational" trainNumber="4103">
        <trainPartSequence sequence="1"><trainPartRef ref="p2"/></trainPartSequence>
      </train>
    </trains>
  </timetable>
"""
"""From West past Middle to the mine, and one to a place that is on no track."""
